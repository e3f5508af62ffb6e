#include "ibrdf/uncertainty/band_limit.h"

#include <glog/logging.h>

#include <cmath>

namespace ibrdf {

double LeastAlpha(int num_views, double t) {
  CHECK_GE(num_views, 1);
  CHECK(t > 0.0 && t < 1.0);
  return std::sqrt(-std::log(t) / num_views);
}

int ViewsForRoughness(double roughness, double t) {
  CHECK(roughness > 0.0 && roughness <= 1.0);
  CHECK(t > 0.0 && t < 1.0);
  const double alpha = roughness * roughness;
  constexpr double kMostViews = 1e9;
  // Rounding must not ask for one more view.
  const double views = -std::log(t) / (alpha * alpha) * (1.0 - 1e-12);
  return static_cast<int>(std::ceil(std::min(views, kMostViews)));
}

double PrefilterAlpha(int num_views) {
  CHECK_GE(num_views, 1);
  return 1.0 / std::floor(std::sqrt(num_views));
}

std::vector<uint8_t> BelowBandLimit(const EntropyMaps& maps,
                                    const BandLimitOptions& options) {
  std::vector<uint8_t> out(maps.num_texels, 1);
  for (int texel = 0; texel < maps.num_texels; ++texel) {
    for (int c = 0; c < 3; ++c) {
      const size_t at = 3 * static_cast<size_t>(texel) + c;
      if (maps.misfit[at] <= options.misfit ||
          maps.deviations[at] <= options.deviations) {
        out[texel] = 0;
      }
    }
  }
  return out;
}

}  // namespace ibrdf
