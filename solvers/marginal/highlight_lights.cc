#include "ibrdf/solvers/marginal/highlight_lights.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/priors/directional_lights.h"

namespace ibrdf {
namespace {

// Two directional lights within this angle, degrees, are one.
constexpr double kReach = 20.0;

// [points]; empty: none.
std::vector<char> ClippedPoints(const Observations& observed) {
  std::vector<char> clipped;
  for (size_t k = 0; !observed.exact() && k < observed.high.size(); k += 3) {
    clipped.push_back(
        std::any_of(observed.high.begin() + k, observed.high.begin() + k + 3,
                    [](double high) { return std::isinf(high); }));
  }
  return clipped;
}

bool IsNearOneOf(const std::vector<Eigen::Vector3d>& lights,
                 const Eigen::Vector3d& direction) {
  const double reach = std::cos(kReach * kDegree);
  return std::any_of(lights.begin(), lights.end(), [&](const auto& light) {
    return light.dot(direction) >= reach;
  });
}

// The image without what is known of its paint: a bright patch is no highlight.
std::vector<double> RadianceWithoutPaint(
    const Observations& observed, const ReflectanceSearchOptions& options) {
  std::vector<double> out = observed.radiance;
  if (!options.paint || options.paint->mean.empty()) return out;
  CHECK_EQ(options.paint->mean.size(), out.size());
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] *= std::exp(-options.paint->mean[i]);
  }
  return out;
}

// The lights that a material's highlights show: where two materials meet, the
// brighter one has none. all: radiance [points * 3].
std::vector<Eigen::Vector3d> LightsOfMaterial(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const std::vector<double>& all, int material,
    const ReflectanceSearchOptions& options) {
  const std::vector<char> clipped = ClippedPoints(observed);
  if (options.num_materials == 1) {
    return FindDirectionalLights(points, all, options.most_directional_lights,
                                 clipped);
  }
  std::vector<ShadingPoint> of_material;
  std::vector<double> radiance;
  std::vector<char> of_clipped;
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i].material != material) continue;
    of_material.push_back(points[i]);
    radiance.insert(radiance.end(), &all[3 * i], &all[3 * i] + 3);
    if (!clipped.empty()) of_clipped.push_back(clipped[i]);
  }
  return FindDirectionalLights(of_material, radiance,
                               options.most_directional_lights, of_clipped);
}

}  // namespace

std::vector<Eigen::Vector3d> LightsOfHighlights(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const ReflectanceSearchOptions& options) {
  const std::vector<double> radiance = RadianceWithoutPaint(observed, options);
  std::vector<std::vector<Eigen::Vector3d>> found;
  for (int m = 0; m < options.num_materials; ++m) {
    found.push_back(LightsOfMaterial(points, observed, radiance, m, options));
  }
  std::vector<Eigen::Vector3d> lights = options.directional_lights;
  // Those of one material are apart.
  const std::vector<Eigen::Vector3d>& others =
      options.num_materials == 1 ? options.directional_lights : lights;
  for (size_t rank = 0;
       rank < static_cast<size_t>(options.most_directional_lights); ++rank) {
    for (const std::vector<Eigen::Vector3d>& of_material : found) {
      if (rank >= of_material.size()) continue;
      if (!IsNearOneOf(others, of_material[rank])) {
        lights.push_back(of_material[rank]);
      }
    }
  }
  if (static_cast<int>(lights.size()) > options.most_directional_lights) {
    lights.resize(options.most_directional_lights);
  }
  return lights;
}

}  // namespace ibrdf
