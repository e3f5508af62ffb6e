#include "ibrdf/render/scene_probe.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/image/darkest.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

constexpr double kGoldenAngle = kPi * (3.0 - 2.23606797749978969641);
// Patches are coarser than a solve takes.
constexpr double kProbePatch = 0.2;
constexpr int kProbePatches = 500;

}  // namespace

SceneProbe ProbeScene(const Scene& scene,
                      const std::vector<ShadingPoint>& points,
                      const SceneProbeOptions& options) {
  CHECK(options.max_points > 0 && options.rays_per_point > 0);
  SceneProbe probe;
  if (!scene.CastsShadows() || points.empty()) return probe;
  const std::vector<ShadingPoint> few =
      SpreadPoints(points, options.max_points);
  const int rays = options.rays_per_point;
  std::vector<double> hidden(few.size());
  ParallelFor(static_cast<int64_t>(few.size()), options.num_threads,
              [&](int64_t i, int) {
                const Eigen::Vector3d n =
                    few[i].normal.cast<double>().normalized();
                const Eigen::Vector3d t = n.unitOrthogonal(), b = n.cross(t);
                int count = 0;
                for (int k = 0; k < rays; ++k) {
                  // A spiral of equal shares of the cosine.
                  const double r = std::sqrt((k + 0.5) / rays);
                  const double phi = k * kGoldenAngle;
                  const Eigen::Vector3d direction =
                      r * (std::cos(phi) * t + std::sin(phi) * b) +
                      std::sqrt(1.0 - r * r) * n;
                  count += scene.Occluded(few[i].position, direction) ? 1 : 0;
                }
                hidden[i] = static_cast<double>(count) / rays;
              });
  probe.points = static_cast<int>(few.size());
  probe.rays = static_cast<int64_t>(few.size()) * rays;
  for (const double h : hidden) {
    probe.hidden_mean += h / static_cast<double>(hidden.size());
  }
  probe.shadowed_share =
      static_cast<double>(std::count_if(hidden.begin(), hidden.end(),
                                        [](double h) { return h > 0.0; })) /
      static_cast<double>(hidden.size());
  std::sort(hidden.begin(), hidden.end());
  probe.hidden_90 = hidden[hidden.size() * 9 / 10];
  probe.hidden_max = hidden.back();
  return probe;
}

double MeanAbsLogRatio(const std::vector<double>& a,
                       const std::vector<double>& b) {
  CHECK_EQ(a.size(), b.size());
  const auto count = static_cast<double>(b.size());
  double mean = 0.0, sum = 0.0;
  for (const double e : b) mean += e / count;
  if (!(mean > 0.0)) return 0.0;
  for (size_t i = 0; i < b.size(); ++i) {
    sum += std::abs(std::log(std::max(a[i], kDarkestShare * mean)) -
                    std::log(std::max(b[i], kDarkestShare * mean)));
  }
  return sum / count;
}

OmissionErrors PredictEffects(const Scene& scene,
                              const std::vector<ShadingPoint>& points,
                              const std::vector<ProbeLook>& looks,
                              const SceneProbeOptions& options) {
  CHECK(!looks.empty());
  OmissionErrors omission;
  if (!scene.CastsShadows() || points.empty()) return omission;
  const std::vector<ShadingPoint> few =
      SpreadPoints(points, options.max_points);
  const int height = looks[0].map->height, width = looks[0].map->width;
  TransportOptions bare, all;
  bare.num_threads = options.num_threads;
  bare.grid = looks[0].brdf->shape;
  all = bare;
  VisibilityOptions rays;
  rays.num_threads = options.num_threads;
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const double share =
      static_cast<double>(points.size()) / static_cast<double>(few.size());
  Clock::time_point start = Clock::now();
  all.visibility = std::make_shared<Visibility>(scene, few, rays);
  omission.shadow_seconds = since(start) * share;
  RadiosityOptions patches;
  patches.bounces = kMostBounces;
  patches.patch_size = kProbePatch;
  patches.max_patches = kProbePatches;
  patches.num_threads = options.num_threads;
  start = Clock::now();
  all.patches =
      std::make_shared<RadiosityPatches>(scene, few, all.visibility, patches);
  omission.bounce_seconds = since(start) * share;
  const Transport without(few, height, width, bare);
  const Transport with(few, height, width, all);
  std::vector<double> full(3 * few.size()), part(full.size());
  for (const ProbeLook& look : looks) {
    CHECK(look.map->height == height && look.map->width == width);
    with.Render(*look.brdf, look.map->rgb.data(), full.data());
    const auto keep_larger = [&](double* error) {
      *error = std::max(*error, MeanAbsLogRatio(part, full));
    };
    without.Render(*look.brdf, look.map->rgb.data(), part.data());
    keep_larger(&omission.unshadowed);
    // A convex object has no patches.
    for (int b = 0; b < with.bounces(); ++b) {
      with.RenderBounces(*look.brdf, look.map->rgb.data(), b, part.data());
      keep_larger(&omission.bounces[b]);
    }
  }
  return omission;
}

}  // namespace ibrdf
