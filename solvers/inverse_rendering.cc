#include "solvers/inverse_rendering.h"

#include "solvers/estimate/estimator.h"
#include "solvers/exposure.h"

namespace ibrdf {

StatusOr<Estimate> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop) {
  const double exposure = ExposureOf(problem);
  const InverseProblem scaled = InUnitsOf(exposure, problem);
  StatusOr<Estimate> estimate = Estimator(scaled, progress, stop).Run();
  if (estimate.ok()) RestoreUnits(exposure, &estimate.value());
  return estimate;
}

}  // namespace ibrdf
