#include "ibrdf/solvers/estimation/inverse_rendering.h"

#include "ibrdf/solvers/estimation/estimator.h"
#include "ibrdf/solvers/estimation/exposure.h"
#include "ibrdf/solvers/estimation/light_gauge.h"

namespace ibrdf {

StatusOr<Solution> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop) {
  const double exposure = ExposureOf(problem);
  const InverseProblem scaled = InUnitsOf(exposure, problem);
  StatusOr<Solution> estimate = Estimator(scaled, progress, stop).Run();
  if (!estimate.ok()) return estimate;
  RestoreUnits(exposure, &*estimate);
  if (problem.solver.gauge != SolverGauge::kPrior &&
      !problem.known_map.has_value() && !problem.known_brdf.has_value()) {
    SetGauge(problem.solver.gauge, problem.lobes, &*estimate);
  }
  return estimate;
}

}  // namespace ibrdf
