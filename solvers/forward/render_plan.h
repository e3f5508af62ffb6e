// What a render simulates and by which means, decided before its pixels are
// rendered.
#pragma once
#include <memory>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/effects/effects_plan.h"
#include "ibrdf/solvers/forward/approximate_radiance.h"
#include "ibrdf/solvers/forward/approximation_plan.h"
#include "ibrdf/solvers/forward/forward_scene.h"
#include "ibrdf/solvers/forward/scene_radiance.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

// What a render may be off by: mean changes of log radiance. The defaults are a
// preview's. experiments/effects and docs/notes (effects) have the
// measurements.
struct RenderTolerances {
  // By effects that are left out.
  double omission = kPreviewOmissionError;
  // By interpolation between normals, by harmonics or by Gaussians.
  double approximation = 3e-3;
  // By the centre of a pixel taken for all of it. At 0.01 matte and glossy
  // scenes were off by 0.0043 to 0.0068.
  double pixel = 3e-3;
  // By twice the rays of narrow lobes, which is about what the image is off by:
  // 0.022 to 0.058 in the mirror-like scenes of the armadillo, at most 0.0125
  // in the nine others.
  double lobe = 0.015;

  static RenderTolerances Of(RenderQuality quality);
};

struct RenderPlan {
  EffectsPlan effects;
  ApproximationPlan approximation;
  // Rays along which each narrow lobe sees the object; 0: it has no narrow lobe
  // or there are no bounces.
  int lobe_rays = 0;
};

// A plan, and the renderers that were set up to make it. Refers to the scene.
struct PlannedRender {
  RenderPlan plan;
  std::unique_ptr<SceneRadiance> radiance;
  std::unique_ptr<ApproximateRadiance> approximation;

  // What renders points: the approximation where one is taken.
  const RadianceRenderer& renderer() const;
};

// Chooses the effects first, then how the points are rendered if nothing
// shadows them.
StatusOr<PlannedRender> PlanRender(const Problem& problem,
                                   const ForwardScene& scene, int num_threads);

}  // namespace ibrdf
