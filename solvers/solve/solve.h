// The solve: reflectance, illumination or both from one image of an object of
// known shape, by the posterior of Chen et al. 2020, Eq. 1.
#pragma once
#include <atomic>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// kInvalidInput if no pixel can be used, or the method refuses the problem.
// `stop` may be null; once it is true the best iterate so far is returned.
StatusOr<Solution> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop);

}  // namespace ibrdf
