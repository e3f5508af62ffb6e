// What a few rays from a few points tell of an object: whether it is convex as
// seen, and what leaving its shadows out would do to an image.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/render/scene.h"

namespace ibrdf {

struct SceneProbeOptions {
  int max_points = 384;      // evenly spread over the list of points
  int rays_per_point = 128;  // cosine-weighted, the same for every point
  int num_threads = 0;
};

struct SceneProbe {
  int points = 0;  // probed
  int64_t rays = 0;
  // Share of the cosine-weighted hemisphere that the object hides from a point
  // (one minus ambient occlusion's sky): mean, 90th percentile, largest.
  double hidden_mean = 0.0;
  double hidden_90 = 0.0;
  double hidden_max = 0.0;
  // Points from which any ray is hidden. 0: convex as far as these rays tell.
  double shadowed_share = 0.0;
};

// Points of a scene; none of what CastsShadows() is false for costs a ray.
SceneProbe ProbeScene(const Scene& scene,
                      const std::vector<ShadingPoint>& points,
                      const SceneProbeOptions& options);

// A light and a reflectance to try shadows with.
struct ProbeLook {
  const Image* map;  // any size; taken as it is
  const BrdfGrid* brdf;
};

struct ShadowWorth {
  // Mean |log E without shadows - log E with| over points and channels, the
  // largest of the looks; radiance below 1e-3 of the mean counts as that.
  double log_error = 0.0;
  int look = 0;  // the index of that one
  // Of the rays that a solve would cast from all the points, predicted from
  // the time of those cast here. Varies from run to run; decides nothing.
  double seconds = 0.0;
};

// Renders the probed points with and without shadows under each of the looks
// (at least one; maps of one size, grids of one shape).
ShadowWorth PredictShadowWorth(const Scene& scene,
                               const std::vector<ShadingPoint>& points,
                               const std::vector<ProbeLook>& looks,
                               const SceneProbeOptions& options);

}  // namespace ibrdf
