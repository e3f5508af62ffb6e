#include "solvers/natural_noise.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>

#include "ibrdf/base/normal_source.h"
#include "ibrdf/light/environment_map.h"
#include "solvers/marginal/light_process.h"
#include "solvers/process_illumination.h"

namespace ibrdf {

namespace {

// Draws of finer maps are taken at a half of their size, and so on.
constexpr int kMostWidth = 256;
constexpr int kMostHeight = 256;

// [height][width] of a channel, bilinear between its texels' centres.
std::vector<float> Resampled(const float* channel, int from_height,
                             int from_width, int height, int width) {
  std::vector<float> out;
  out.reserve(static_cast<size_t>(height) * width);
  for (int r = 0; r < height; ++r) {
    for (int x = 0; x < width; ++x) {
      const MapTaps taps =
          BilinearTaps(MapDirection(r + 0.5, x + 0.5, height, width),
                       from_height, from_width);
      double sum = 0.0;
      for (int k = 0; k < 4; ++k)
        sum += taps.weight[k] * channel[taps.texel[k]];
      out.push_back(static_cast<float>(sum));
    }
  }
  return out;
}

}  // namespace

std::vector<float> NaturalNoise(const IlluminationUnetOptions& options) {
  int width = options.width, height = options.height;
  while (width > kMostWidth || height > kMostHeight) {
    width = std::max(width / 4 * 2, 2);
    height = std::max(height / 2, 1);
  }
  const bool same = width == options.width && height == options.height;
  const std::unique_ptr<IlluminationModel> process = MakeProcessIllumination(
      width, height, LightProcess(), LightScales::Average());
  std::vector<float> white(process->num_parameters());
  std::vector<float> draw(process->num_outputs()), noise;
  NormalSource normal(options.seed);
  const Eigen::Index texels = Eigen::Index{width} * height;
  for (int k = 0; k < options.noise_channels; ++k) {
    for (float& w : white) w = normal.Next();
    process->Forward(white.data(), draw.data());
    // The others of its colours are nearly the same.
    std::vector<float> channel(draw.begin(), draw.begin() + texels);
    if (!same) {
      channel =
          Resampled(draw.data(), height, width, options.height, options.width);
    }
    Eigen::Map<Eigen::ArrayXf> red(channel.data(),
                                   static_cast<Eigen::Index>(channel.size()));
    red -= red.mean();
    red /= std::sqrt(red.square().mean());
    noise.insert(noise.end(), channel.begin(), channel.end());
  }
  return noise;
}

}  // namespace ibrdf
