// A problem file's inputs, read and checked.
#pragma once
#include <cstdint>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/problem/inverse_problem.h"
#include "ibrdf/solvers/problem/load_object.h"

namespace ibrdf {

// Reads what else a checked problem names, and decides the effects. `object`:
// as LoadPhotographedObject has it for the problem.
StatusOr<InverseProblem> LoadInverseProblem(const Problem& problem,
                                            PhotographedObject object,
                                            uint64_t default_seed,
                                            int num_threads);

// Both: reads every file that a checked problem names and finds the object's
// pixels.
StatusOr<InverseProblem> LoadInverseProblem(const Problem& problem,
                                            uint64_t default_seed,
                                            int num_threads);

}  // namespace ibrdf
