// The reflectance with the light integrated out, and what that says of the
// light.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
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

// What a search among several models found with one of them.
struct ModelOptima {
  const SolveSetup* setup = nullptr;
  // Its materials say the level; null under a known light, which tells it.
  std::shared_ptr<const LevelGauge> gauge;
  ReflectanceEstimate estimate;

  // A material's, at the gauge's level; empty where none is called so.
  std::vector<double> LobesOf(const std::string& material) const;
};

// Whether what a search found calls for a second one.
using SearchAgain = std::function<bool(const std::vector<ModelOptima>&)>;

// The same among the materials of several models of one image, which compete.
// One of each model that is left at the end, the covariance with the best one
// alone. setups: the same problem with each model; they must outlive the
// result. A search that finds nothing, or of which `again` says so, is followed
// by one that begins with more tolerance of materials that are unlike the
// object's, and the optima of both compete; empty: there is one search.
StatusOr<std::vector<ModelOptima>> EstimateReflectances(
    const std::vector<const SolveSetup*>& setups, SolveContext* context,
    const SearchAgain& again);

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
