// What a few rays from a few points tell of an object: whether it is convex as
// seen, and what leaving out its shadows, or the light from itself, would do to
// an image.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"

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

// A light and a reflectance to try effects with.
struct ProbeLook {
  const Image* map;  // any size; taken as it is
  const BrdfGrid* brdf;
};

// Bounces beyond these change nothing that is looked for here: a quarter of the
// light hidden and an albedo of 0.9 leave 0.0006 of it to the fifth.
inline constexpr int kMostBounces = 4;

struct OmissionErrors {
  // Mean |log L_o - log L_o_all| over points and channels, the largest of the
  // looks, of L_o without shadows, and of L_o with shadows and b bounces,
  // b = 0 to kMostBounces; L_o_all has all of those. Radiance below 1e-3 of the
  // mean counts as that.
  double unshadowed = 0.0;
  std::array<double, kMostBounces + 1> bounces = {};
  // Seconds of the rays that a solve would cast from all the points, for
  // shadows and, beyond those, for bounces: predicted from the time of those
  // cast here. Vary from run to run; decide nothing.
  double shadow_seconds = 0.0, bounce_seconds = 0.0;
};

// Mean |log a - log b| of radiance, below 1e-3 of the mean of b counted as
// that; 0 where b is black. Of one size.
double MeanAbsLogRatio(const std::vector<double>& a,
                       const std::vector<double>& b);

// Renders the probed points with and without the effects under each of the
// looks (at least one; maps of one size, grids of one shape).
OmissionErrors PredictEffects(const Scene& scene,
                              const std::vector<ShadingPoint>& points,
                              const std::vector<ProbeLook>& looks,
                              const SceneProbeOptions& options);

}  // namespace ibrdf
