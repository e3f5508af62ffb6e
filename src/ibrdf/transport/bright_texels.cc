#include "ibrdf/transport/bright_texels.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr size_t kMostTexels = 32;
constexpr double kContrast = 30.0;  // to the map's mean
constexpr double kLeastShare = 0.002;
constexpr int kLeastRows = 45;

}  // namespace

BrightTexels SplitBrightTexels(const Image& map) {
  if (map.height < kLeastRows) return {{}, map};
  const size_t count = map.num_pixels();
  std::vector<float> strength(count);  // of the strongest channel
  double power = 0.0;
  for (size_t t = 0; t < count; ++t) {
    const float* rgb = map.rgb.data() + 3 * t;
    strength[t] = std::max({rgb[0], rgb[1], rgb[2]});
    power += strength[t] * TexelSolidAngle(static_cast<int>(t / map.width),
                                           map.height, map.width);
  }
  BrightTexels split;
  split.rest = map;
  double cap = kContrast * power / (4.0 * kPi);
  if (count > kMostTexels) {
    std::vector<float> order = strength;
    std::nth_element(order.begin(), order.begin() + kMostTexels, order.end(),
                     std::greater<float>());
    cap = std::max<double>(cap, order[kMostTexels]);
  }
  double taken = 0.0;
  for (size_t t = 0; t < count; ++t) {
    if (!(strength[t] > cap)) continue;
    BrightTexel texel;
    texel.row = static_cast<int>(t / map.width);
    texel.column = static_cast<int>(t % map.width);
    for (int c = 0; c < 3; ++c) {
      float* const value = &split.rest.rgb[3 * t + c];
      const auto kept = static_cast<float>(*value * (cap / strength[t]));
      texel.excess[c] = static_cast<double>(*value) - kept;
      *value = kept;
    }
    taken +=
        (strength[t] - cap) * TexelSolidAngle(texel.row, map.height, map.width);
    split.texels.push_back(texel);
  }
  if (!(taken >= kLeastShare * power)) return {{}, map};
  return split;
}

std::vector<BrightSample> SampleBrightTexels(
    const std::vector<BrightTexel>& texels, int map_height, int map_width,
    int per_side) {
  CHECK(per_side > 0 && per_side % 2 == 0);
  const int half = per_side / 2;   // samples from a texel's centre to the next
  const double step = 1.0 / half;  // texels
  const double cell = step * kPi / map_height * step * 2.0 * kPi / map_width;
  // By row and column of their grid, which has `half` steps to a texel; the
  // first step begins half a texel before the map.
  std::map<std::pair<int, int>, Eigen::Array3d> excess;
  for (const BrightTexel& texel : texels) {
    for (int i = 0; i < per_side; ++i) {
      const double v = (i + 0.5) * step - 1.0;
      for (int j = 0; j < per_side; ++j) {
        const double u = (j + 0.5) * step - 1.0;
        const int columns = map_width * half;
        const int column = (texel.column * half + j + columns) % columns;
        auto& sum = excess
                        .try_emplace({texel.row * half + i, column},
                                     Eigen::Array3d::Zero())
                        .first->second;
        sum += texel.excess * ((1.0 - std::abs(u)) * (1.0 - std::abs(v)));
      }
    }
  }
  std::vector<BrightSample> samples;
  for (const auto& [at, radiance] : excess) {
    // Beyond a pole the same formulas go on across it.
    const double row = (at.first + 0.5) * step - 0.5;
    const double column = (at.second + 0.5) * step - 0.5;
    BrightSample sample;
    sample.direction = MapDirection(row, column, map_height, map_width);
    sample.power =
        radiance * (std::abs(std::sin(kPi * row / map_height)) * cell);
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace ibrdf
