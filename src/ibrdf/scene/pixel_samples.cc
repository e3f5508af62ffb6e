#include "ibrdf/scene/pixel_samples.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ibrdf/image/darkest.h"

namespace ibrdf {
namespace {

// The share of a second difference between pixels: 1/24 for the mean of a
// parabola over a pixel, a quarter for an edge at a random place.
constexpr double kShare = 1.0 / 8;

}  // namespace

std::vector<double> CentreErrors(const Image& image, const Mask& mask) {
  CHECK(image.width == mask.width && image.height == mask.height);
  const int width = image.width, height = image.height;
  std::vector<double> bends(image.num_pixels(), 0.0);
  double mean = 0.0;
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    if (mask.inside[k / 3] != 0) mean += image.rgb[k];
  }
  mean /= 3.0 * static_cast<double>(std::max<size_t>(mask.CountInside(), 1));
  if (!(mean > 0.0)) return bends;
  const auto inside = [&](int x, int y) {
    return x >= 0 && x < width && y >= 0 && y < height &&
           mask.inside[static_cast<size_t>(y) * width + x] != 0;
  };
  const auto log_at = [&](int x, int y, int c) {
    return std::log(
        std::max(static_cast<double>(image.At(x, y)[c]), kDarkestShare * mean));
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!inside(x, y)) continue;
      double sum = 0.0;
      for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
        const bool before = inside(x - dx, y - dy);
        const bool after = inside(x + dx, y + dy);
        for (int c = 0; c < 3; ++c) {
          // At the limb, where one side is missing, a step stands for a bend.
          const double here = log_at(x, y, c);
          const double to = after ? log_at(x + dx, y + dy, c) - here : 0.0;
          const double from = before ? here - log_at(x - dx, y - dy, c) : 0.0;
          sum += std::abs(to - from);
        }
      }
      bends[static_cast<size_t>(y) * width + x] = kShare * sum / 3.0;
    }
  }
  // Detail finer than pixels may leave one as bright as its neighbours.
  std::vector<double> errors(image.num_pixels(), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!inside(x, y)) continue;
      double around = 0.0;
      int count = 0;
      for (int k = 0; k < 9; ++k) {
        const int u = x + k % 3 - 1, v = y + k / 3 - 1;
        if (k == 4 || !inside(u, v)) continue;
        around += bends[static_cast<size_t>(v) * width + u];
        ++count;
      }
      const size_t pixel = static_cast<size_t>(y) * width + x;
      errors[pixel] = std::max(bends[pixel], count > 0 ? around / count : 0.0);
    }
  }
  return errors;
}

Mask PixelsToSample(const Image& image, const Mask& mask, double log_error) {
  const std::vector<double> errors = CentreErrors(image, mask);
  std::vector<size_t> order(errors.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return errors[a] > errors[b]; });
  double left = std::accumulate(errors.begin(), errors.end(), 0.0);
  const double allowed = log_error * static_cast<double>(mask.CountInside());
  Mask out;
  for (const size_t pixel : order) {
    if (left <= allowed || errors[pixel] == 0.0) break;
    if (out.empty()) out = Mask(mask.width, mask.height, 0);
    out.inside[pixel] = 255;
    left -= errors[pixel];
  }
  return out;
}

}  // namespace ibrdf
