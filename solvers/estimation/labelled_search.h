// The reflectances of several materials in one light, with the light integrated
// out.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

struct LabelledReflectance {
  // By ShadingPoint::material. What they say of the light is in `light`;
  // covariances are of each material by itself, costs of candidates of all.
  std::vector<ReflectanceEstimate> materials;
  LightPosterior light;
};

// The reflectances whose posterior together is highest, for the labels of the
// problem. First each material is searched for by itself, cheaply: that leaves
// a few candidates of each, and the light that each of them implies.
// Combinations of these, brought to one light, are what the joint search begins
// from. The materials' mean levels together are at those of the prior
// (LevelGauge). kNoImprovement as EstimateReflectance.
StatusOr<LabelledReflectance> EstimateLabelledReflectance(
    const SolveSetup& setup, SolveContext* context);

}  // namespace ibrdf
