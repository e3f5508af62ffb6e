#include "solvers/inverse_rendering.h"

#include "solvers/estimate/estimator.h"

namespace ibrdf {

StatusOr<Estimate> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop) {
  return Estimator(problem, progress, stop).Run();
}

}  // namespace ibrdf
