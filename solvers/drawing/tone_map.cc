#include "ibrdf/solvers/drawing/tone_map.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ibrdf {
namespace {}  // namespace

double Percentile(std::vector<double> values, double percentile) {
  const size_t rank =
      std::min(values.size() - 1,
               static_cast<size_t>(percentile / 100.0 *
                                   static_cast<double>(values.size())));
  std::nth_element(values.begin(),
                   values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

double DecodeSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92
                            : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double ExposureOf(const Image& reference, const Mask& mask, double percentile) {
  std::vector<double> values;
  for (size_t i = 0; i < reference.num_pixels(); ++i) {
    const float* rgb = &reference.rgb[3 * i];
    const double value = std::max({rgb[0], rgb[1], rgb[2]});
    if (mask.Holds(i) && std::isfinite(value) && value > 0.0) {
      values.push_back(value);
    }
  }
  return values.empty() ? 1.0 : 1.0 / Percentile(std::move(values), percentile);
}

uint8_t EncodeSrgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded =
      x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(255.0 * encoded));
}

Image LogRatio(const Image& image, const Image& reference, const Mask& mask) {
  CHECK_EQ(image.rgb.size(), reference.rgb.size());
  double largest = 0.0;
  for (size_t k = 0; k < reference.rgb.size(); ++k) {
    const double value = reference.rgb[k];
    if (mask.Holds(k / 3) && std::isfinite(value)) {
      largest = std::max(largest, value);
    }
  }
  const double floor =
      std::max(1e-6 * largest, std::numeric_limits<double>::min());
  Image ratio(image.width, image.height);
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    const double a = image.rgb[k], b = reference.rgb[k];
    ratio.rgb[k] = std::isfinite(a) && std::isfinite(b)
                       ? static_cast<float>(std::log(std::max(a, 0.0) + floor) -
                                            std::log(std::max(b, 0.0) + floor))
                       : std::numeric_limits<float>::quiet_NaN();
  }
  return ratio;
}

void DivergingColour(double t, uint8_t rgb[3]) {
  const double ends[2][3] = {{33, 82, 172}, {178, 24, 43}};  // blue, red
  const double* const end = ends[t > 0.0 ? 1 : 0];
  const double strength = std::min(std::fabs(t), 1.0);
  for (int c = 0; c < 3; ++c) {
    rgb[c] =
        static_cast<uint8_t>(std::lround(255.0 + strength * (end[c] - 255.0)));
  }
}

}  // namespace ibrdf
