#include "ibrdf/solvers/drawing/tone_map.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/image/response_curve.h"

namespace ibrdf {
namespace {

const ResponseCurve& Srgb() {
  static const ResponseCurve curve({ResponseKind::kSrgb, {}, {}});
  return curve;
}

}  // namespace

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

double DecodeSrgb(double encoded) { return Srgb().Decode(encoded); }

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
  const double encoded = Srgb().Encode(std::clamp(linear, 0.0, 1.0));
  return static_cast<uint8_t>(std::lround(255.0 * encoded));
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
