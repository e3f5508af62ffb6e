#include "ibrdf/light/log_map.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// of(texel with channel in pixels [texels, 3], the same in planes [3][texels]).
template <typename Of>
void ForEachValue(size_t texels, const Of& of) {
  for (size_t t = 0; t < texels; ++t) {
    for (size_t c = 0; c < 3; ++c) of(3 * t + c, c * texels + t);
  }
}

}  // namespace

LogMap::LogMap(MapSize size, std::vector<float> planes)
    : size_(size), values_(std::move(planes)) {
  CHECK_EQ(values_.size(), 3 * num_texels());
}

void LogMap::Reshape(MapSize size) {
  size_ = size;
  values_.resize(3 * num_texels());
}

void LogMap::Exp(std::vector<float>* map, std::vector<float>* slopes) const {
  map->resize(values_.size());
  if (slopes != nullptr) slopes->resize(values_.size());
  ForEachValue(num_texels(), [&](size_t pixel, size_t plane) {
    const float l = values_[plane];
    const float L = std::exp(std::clamp(l, -kMaxLogRadiance, kMaxLogRadiance));
    (*map)[pixel] = L;
    if (slopes != nullptr) {
      (*slopes)[pixel] = std::abs(l) < kMaxLogRadiance ? L : 0.0f;
    }
  });
}

LogMap LogMap::Resized(MapSize size) const {
  return {size, ResamplePlanes(values_, size_, size)};
}

Eigen::Array3d LogMap::Mean() const {
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  const int H = size_.height, W = size_.width;
  for (int c = 0; c < 3; ++c) {
    const auto plane = Plane(c);
    for (int r = 0; r < H; ++r) {
      const double w = TexelSolidAngle(r, H, W) / (4 * kPi);
      for (int x = 0; x < W; ++x) mean[c] += w * plane(r, x);
    }
  }
  return mean;
}

void ExpJvp(const std::vector<float>& slopes, const LogMap& d_log,
            std::vector<float>* d_map) {
  CHECK_EQ(slopes.size(), d_log.values().size());
  d_map->resize(slopes.size());
  ForEachValue(d_log.num_texels(), [&](size_t pixel, size_t plane) {
    (*d_map)[pixel] = slopes[pixel] * d_log.values()[plane];
  });
}

void AddExpVjp(const std::vector<float>& slopes,
               const std::vector<float>& by_map, LogMap* by_log) {
  CHECK_EQ(slopes.size(), by_map.size());
  CHECK_EQ(slopes.size(), by_log->values().size());
  float* const out = by_log->data();
  ForEachValue(by_log->num_texels(), [&](size_t pixel, size_t plane) {
    out[plane] += by_map[pixel] * slopes[pixel];
  });
}

std::vector<float> RelativeMap(const double* log_radiance, int num_texels) {
  const size_t texels = num_texels;
  const double highest =
      *std::max_element(log_radiance, log_radiance + 3 * texels);
  std::vector<float> map(3 * texels);
  ForEachValue(texels, [&](size_t pixel, size_t plane) {
    map[pixel] = static_cast<float>(std::exp(log_radiance[plane] - highest));
  });
  return map;
}

}  // namespace ibrdf
