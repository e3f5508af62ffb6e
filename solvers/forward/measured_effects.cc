#include "ibrdf/solvers/forward/measured_effects.h"

#include <glog/logging.h>

#include <algorithm>
#include <chrono>

namespace ibrdf {
namespace {

// A tenth of those of a small image: some tens of points that see the object
// in itself.
constexpr int kPoints = 384;

std::vector<double> Rendered(const SceneRadiance& radiance,
                             const std::vector<ShadingPoint>& points) {
  std::vector<double> L_o(3 * points.size());
  radiance.Render(points, nullptr, L_o.data());
  return L_o;
}

}  // namespace

OmissionErrors MeasureEffects(const SceneRadiance& bare,
                              const std::vector<ShadingPoint>& points,
                              SceneRadiance* all) {
  CHECK_EQ(kMostBounces, all->bounces());
  OmissionErrors omission;
  const std::vector<ShadingPoint> few = SpreadPoints(points, kPoints);
  const double share =
      static_cast<double>(points.size()) / static_cast<double>(few.size());
  const auto render = [&](const SceneRadiance& radiance, double* seconds) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    std::vector<double> L_o = Rendered(radiance, few);
    *seconds =
        share * std::chrono::duration<double>(Clock::now() - start).count();
    return L_o;
  };
  double bare_seconds = 0.0, shadow_seconds = 0.0, all_seconds = 0.0;
  const std::vector<double> full = render(*all, &all_seconds);
  omission.unshadowed = MeanAbsLogRatio(render(bare, &bare_seconds), full);
  for (int b = 0; b < kMostBounces; ++b) {
    all->set_bounces(b);
    double seconds = 0.0;
    omission.bounces[b] = MeanAbsLogRatio(render(*all, &seconds), full);
    if (b == 0) shadow_seconds = seconds;
  }
  all->set_bounces(kMostBounces);
  omission.shadow_seconds = std::max(shadow_seconds - bare_seconds, 0.0);
  omission.bounce_seconds = std::max(all_seconds - shadow_seconds, 0.0);
  return omission;
}

double ChooseLobeRays(const std::vector<ShadingPoint>& points, double log_error,
                      SceneRadiance* all) {
  const std::vector<ShadingPoint> few = SpreadPoints(points, kPoints);
  std::vector<double> L_o = Rendered(*all, few);
  double change = 0.0;
  while (all->lobe_rays() < SceneRadiance::kMostLobeRays) {
    const int rays = all->lobe_rays();
    all->set_lobe_rays(2 * rays);
    std::vector<double> finer = Rendered(*all, few);
    change = MeanAbsLogRatio(L_o, finer);
    if (change <= log_error) {
      all->set_lobe_rays(rays);
      break;
    }
    L_o = std::move(finer);
  }
  return change;
}

}  // namespace ibrdf
