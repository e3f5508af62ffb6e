// The estimate: reflectance, illumination or both from one image, by the
// posterior of Chen et al. 2020, Eq. 1. Of both: reflectance with the light
// integrated out, then the light, or their joint maximum (Eq. 8).
#pragma once
#include <atomic>
#include <functional>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// A stage's progress, share in [0, 1] of the time or work.
using SolveProgress =
    std::function<void(const TraceEntry& entry, double share)>;

// kInvalidInput if no pixel can be used. `stop` may be null.
StatusOr<Solution> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop);

}  // namespace ibrdf
