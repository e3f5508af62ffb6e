#include "ibrdf/io/exr_chroma.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace ibrdf {
namespace {

// Weights of the samples 1, 3, 5, ... pixels to either side.
constexpr std::array<double, 7> kTaps = {
    0.627123, -0.186077, 0.087929, -0.043159, 0.019597, -0.007540, 0.002128};

// in[k] is pixel 2 k of the line; entries are `stride` apart.
void UpsampleLine(const float* in, size_t in_stride, int in_count, float* out,
                  size_t out_stride, int out_count) {
  const auto sample = [&](int k) {
    const int held = std::clamp(k, 0, in_count - 1);
    return static_cast<double>(in[in_stride * static_cast<size_t>(held)]);
  };
  for (int i = 0; i < out_count; ++i) {
    double value = 0.0;
    if (i % 2 == 0) {
      value = sample(i / 2);
    } else {
      for (int t = 0; t < static_cast<int>(kTaps.size()); ++t) {
        value += kTaps[static_cast<size_t>(t)] *
                 (sample(i / 2 - t) + sample(i / 2 + 1 + t));
      }
    }
    out[out_stride * static_cast<size_t>(i)] = static_cast<float>(value);
  }
}

}  // namespace

std::vector<float> UpsampleChroma(const std::vector<float>& chroma, int width,
                                  int height) {
  const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
  const size_t row = static_cast<size_t>(width);
  std::vector<float> wide(row * static_cast<size_t>(half_height));
  for (int y = 0; y < half_height; ++y) {
    UpsampleLine(&chroma[static_cast<size_t>(y) * half_width], 1, half_width,
                 &wide[row * static_cast<size_t>(y)], 1, width);
  }
  std::vector<float> full(row * static_cast<size_t>(height));
  for (size_t x = 0; x < row; ++x) {
    UpsampleLine(&wide[x], row, half_height, &full[x], row, height);
  }
  return full;
}

void LuminanceChromaToRgb(float y, float ry, float by,
                          const Eigen::Vector3d& weights, float* rgb) {
  const double red = (double{ry} + 1.0) * y;
  const double blue = (double{by} + 1.0) * y;
  // Grey stays grey to the last bit.
  const double green =
      ry == 0.0f && by == 0.0f
          ? double{y}
          : (y - weights[0] * red - weights[2] * blue) / weights[1];
  rgb[0] = static_cast<float>(red);
  rgb[1] = static_cast<float>(green);
  rgb[2] = static_cast<float>(blue);
}

}  // namespace ibrdf
