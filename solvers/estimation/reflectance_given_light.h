// The reflectance under a known light.
#pragma once
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// The materials of the embedding are rendered under the light, the few that
// explain the image best take some steps of Ceres' trust region, and the best
// of those are finished at a scale b that falls with their misfit.
Estimate EstimateReflectanceGivenLight(const SolveSetup& setup,
                                       SolveContext* context);

// The covariance of the lobes at the estimate's pixels, in place of the one it
// has; as it was once the time is over.
void SetCovariance(const SolveSetup& setup, const SolveContext& context,
                   Estimate* estimate);

// The estimate without a covariance; reflectance.candidates are those that took
// more than their first steps, the best one first, their costs at its scale b.
// pixels: the setup's, or means of those of like normals.
Estimate EstimateLobesGivenLight(const SolveSetup& setup,
                                 const Observation& pixels,
                                 SolveContext* context);

}  // namespace ibrdf
