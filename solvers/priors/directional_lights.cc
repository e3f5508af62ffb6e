#include "ibrdf/solvers/priors/directional_lights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "ibrdf/base/median.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

// Seen at smaller cosines, mirrored light is Fresnel's as much as a directional
// light's.
constexpr double kMinCosine = 0.25;
// A highlight is the brightest within this angle of mirrored directions, and
// brighter by this factor than the median at its rim.
constexpr double kReach = 20.0;
constexpr double kRim = 14.0;
constexpr double kContrast = 1.1;
// Rows of the bins of directions, of 5 degrees: far below the reach.
constexpr int kBinRows = 36;
// For NearDirectionalLights: how far a directional light's direction may be
// off, one deviation, and the least weight that counts.
constexpr double kSpread = 4.0;
constexpr double kLeastWeight = 0.05;

// The middle of a clipped plateau: the clipped directions of a bin and of all
// bins that hang together with it, every bin by its solid angle, as an image
// holds more of some directions than of others. `bin`: of each direction.
Eigen::Vector3d MiddleOfClipped(const std::vector<Eigen::Vector3d>& directions,
                                const std::vector<char>& clipped,
                                const std::vector<int>& bin, int first) {
  constexpr int kColumns = 2 * kBinRows;
  std::vector<Eigen::Vector3d> sums(kBinRows * kColumns,
                                    Eigen::Vector3d::Zero());
  for (size_t j = 0; j < directions.size(); ++j) {
    if (clipped[j] != 0) sums[bin[j]] += directions[j];
  }
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::vector<char> seen(sums.size(), 0);
  std::vector<int> open = {first};
  seen[first] = 1;
  while (!open.empty()) {
    const int row = open.back() / kColumns, column = open.back() % kColumns;
    open.pop_back();
    middle += TexelSolidAngle(row, kBinRows, kColumns) *
              sums[row * kColumns + column].normalized();
    for (int k = 0; k < 9; ++k) {
      const int r = std::clamp(row + k / 3 - 1, 0, kBinRows - 1);
      const int next =
          r * kColumns + (column + k % 3 - 1 + kColumns) % kColumns;
      if (seen[next] != 0 || sums[next].isZero()) continue;
      seen[next] = 1;
      open.push_back(next);
    }
  }
  return middle.normalized();
}

}  // namespace

std::vector<Eigen::Vector3d> FindDirectionalLights(
    const std::vector<ShadingPoint>& points,
    const std::vector<double>& radiance, int most,
    const std::vector<char>& clipped) {
  std::vector<Eigen::Vector3d> mirrored;
  std::vector<double> luminance;
  std::vector<char> cut;
  // Only the brightest of a bin can be the brightest within reach, which spares
  // most pixels the look at all others.
  std::vector<int> bin;
  std::vector<double> brightest(2 * kBinRows * kBinRows, 0.0);
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d n = points[i].normal.cast<double>();
    const Eigen::Vector3d wo = points[i].wo.cast<double>();
    const double sum =
        radiance[3 * i] + radiance[3 * i + 1] + radiance[3 * i + 2];
    if (n.dot(wo) < kMinCosine || !std::isfinite(sum) || !(sum > 0.0)) continue;
    mirrored.push_back((2.0 * n.dot(wo) * n - wo).normalized());
    luminance.push_back(sum * n.dot(wo));
    cut.push_back(clipped.empty() ? 0 : clipped[i]);
    double row = 0.0, column = 0.0;
    MapPosition(mirrored.back(), kBinRows, 2 * kBinRows, &row, &column);
    bin.push_back(std::min(static_cast<int>(row), kBinRows - 1) * 2 * kBinRows +
                  std::min(static_cast<int>(column), 2 * kBinRows - 1));
    brightest[bin.back()] = std::max(brightest[bin.back()], luminance.back());
  }
  std::vector<size_t> order(luminance.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return luminance[a] > luminance[b];
  });
  const double reach = std::cos(kReach * kDegree);
  const double rim = std::cos(kRim * kDegree);
  std::vector<Eigen::Vector3d> directional_lights, looked_at;
  for (const size_t i : order) {
    if (static_cast<int>(directional_lights.size()) >= most) break;
    if (luminance[i] != brightest[bin[i]]) continue;
    // The first of equals stands for them: where a highlight is saturated there
    // are many, each with a look at all others, and all are one directional
    // light.
    const bool near = std::any_of(
        looked_at.begin(), looked_at.end(),
        [&](const Eigen::Vector3d& d) { return d.dot(mirrored[i]) >= reach; });
    if (near) continue;
    looked_at.push_back(mirrored[i]);
    bool top = true;
    std::vector<double> around;
    for (size_t j = 0; j < mirrored.size() && top; ++j) {
      const double cosine = mirrored[j].dot(mirrored[i]);
      if (cosine < reach) continue;
      top = luminance[j] <= luminance[i];
      if (cosine < rim) around.push_back(luminance[j]);
    }
    if (!top || around.empty()) continue;
    const double background = UpperMedian(std::move(around));
    if (luminance[i] < kContrast * background) continue;
    const double half = 0.5 * (luminance[i] + background);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (size_t j = 0; j < mirrored.size(); ++j) {
      if (mirrored[j].dot(mirrored[i]) < rim) continue;
      centre += std::max(luminance[j] - half, 0.0) * mirrored[j];
    }
    directional_lights.push_back(
        cut[i] != 0 ? MiddleOfClipped(mirrored, cut, bin, bin[i])
                    : Eigen::Vector3d(centre.normalized()));
  }
  return directional_lights;
}

Eigen::Vector3d MovedDirectionalLight(const Eigen::Vector3d& directional_light,
                                      const double* offsets) {
  const Eigen::Vector3d axis = directional_light.unitOrthogonal();
  return (directional_light + offsets[0] * axis +
          offsets[1] * directional_light.cross(axis))
      .normalized();
}

std::vector<DirectionalLightTexel> NearDirectionalLights(
    const std::vector<Eigen::Vector3d>& directional_lights, int height,
    int width) {
  std::vector<DirectionalLightTexel> near;
  for (int t = 0; t < (directional_lights.empty() ? 0 : height * width); ++t) {
    const Eigen::Vector3d direction =
        MapDirection(t / width + 0.5, t % width + 0.5, height, width);
    double weight = 0.0;
    for (const Eigen::Vector3d& directional_light : directional_lights) {
      const double angle =
          std::acos(std::min(direction.dot(directional_light), 1.0));
      const double spreads = angle / (kDegree * kSpread);
      weight = std::max(weight, std::exp(-0.5 * spreads * spreads));
    }
    if (weight >= kLeastWeight) near.push_back({t, weight});
  }
  return near;
}

}  // namespace ibrdf
