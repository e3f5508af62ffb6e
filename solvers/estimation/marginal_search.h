// The reflectance with the light integrated out, and what that says of the
// light.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/paint/first_paint.h"

namespace ibrdf {

// The reflectance whose posterior is highest with the light integrated out, at
// the materials' mean level (LevelGauge). kNoImprovement where the light
// explains the image of no material. paint: of an object whose albedo varies;
// null: it does not.
StatusOr<ReflectanceEstimate> EstimateReflectance(
    const SolveSetup& setup, SolveContext* context,
    const FirstPaint* paint = nullptr);

// For a known reflectance: directional lights and hyperparameters of highest
// posterior probability with the map integrated out; at the average where the
// image does not tell, or where no stage would use them.
LightPosterior EstimateLightPosterior(const SolveSetup& setup,
                                      SolveContext* context);

// -log posterior of the best reflectance at the search's coarse resolution, the
// light integrated out, nats; infinite where there is none. It compares images
// of the same pixels. paint: the albedo varies, as this says, and is integrated
// out as well; null: it does not.
double CoarseEvidence(const SolveSetup& setup, SolveContext* context,
                      const PaintPrior* paint = nullptr);

// The most central of the model's materials.
ReflectanceEstimate MeanMaterial(const SolveSetup& setup);

}  // namespace ibrdf
