#include "ibrdf/image/texture_sampling.h"

#include <algorithm>
#include <cmath>

namespace ibrdf {

Eigen::Array3f SampleTexture(const Image& texture, const Eigen::Vector2f& uv,
                             bool wrap_u) {
  const int w = texture.width, h = texture.height;
  const float x = std::clamp(uv.x(), 0.0f, 1.0f) * static_cast<float>(w) - 0.5f;
  const float y =
      (1.0f - std::clamp(uv.y(), 0.0f, 1.0f)) * static_cast<float>(h) - 0.5f;
  const float x0 = std::floor(x), y0 = std::floor(y);
  const float fx = x - x0, fy = y - y0;
  const auto column = [&](int i) {
    return wrap_u ? (i + w) % w : std::clamp(i, 0, w - 1);
  };
  const auto row = [&](int j) { return std::clamp(j, 0, h - 1); };
  const int left = column(static_cast<int>(x0));
  const int right = column(static_cast<int>(x0) + 1);
  const int top = row(static_cast<int>(y0));
  const int below = row(static_cast<int>(y0) + 1);
  const auto at = [&](int i, int j) {
    return Eigen::Array3f(Eigen::Map<const Eigen::Array3f>(texture.At(i, j)));
  };
  const Eigen::Array3f upper =
      (1.0f - fx) * at(left, top) + fx * at(right, top);
  const Eigen::Array3f lower =
      (1.0f - fx) * at(left, below) + fx * at(right, below);
  return (1.0f - fy) * upper + fy * lower;
}

}  // namespace ibrdf
