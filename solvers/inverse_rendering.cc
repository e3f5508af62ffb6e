#include "solvers/inverse_rendering.h"

#include "solvers/estimate/estimator.h"
#include "solvers/exposure.h"
#include "solvers/light_gauge.h"

namespace ibrdf {

StatusOr<Estimate> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop) {
  const double exposure = ExposureOf(problem);
  const InverseProblem scaled = InUnitsOf(exposure, problem);
  StatusOr<Estimate> estimate = Estimator(scaled, progress, stop).Run();
  if (!estimate.ok()) return estimate;
  RestoreUnits(exposure, &*estimate);
  if (problem.solver.gauge != SolverGauge::kPrior &&
      !problem.known_map.has_value() && !problem.known_brdf.has_value()) {
    SetGauge(problem.solver.gauge, problem.lobes, &*estimate);
  }
  return estimate;
}

}  // namespace ibrdf
