#include "ibrdf/uncertainty/texel_samples.h"

#include <cmath>
#include <string>

namespace ibrdf {
namespace {

// Radiance above this is no measurement, and its squares leave the range of
// the sums.
constexpr float kLargestRadiance = 1e15f;

Status CheckSize(const char* name, size_t found, size_t expected) {
  if (found == expected) return OkStatus();
  return InvalidInput(name, "has " + std::to_string(found) +
                                " numbers, expected " +
                                std::to_string(expected));
}

bool Measured(const float* rgb, float scale) {
  for (int c = 0; c < 3; ++c) {
    if (!(std::abs(rgb[c] * scale) <= kLargestRadiance)) return false;
  }
  return true;
}

}  // namespace

Status TexelSamples::Check() const {
  if (num_texels < 0) return InvalidInput("num_texels", "expected >= 0");
  if (num_views < 1) return InvalidInput("num_views", "expected >= 1");
  const size_t samples = static_cast<size_t>(num_texels) * num_views;
  IBRDF_RETURN_IF_ERROR(
      CheckSize("directions", directions.size(), 3 * samples));
  IBRDF_RETURN_IF_ERROR(CheckSize("outgoing", outgoing.size(), 3 * samples));
  IBRDF_RETURN_IF_ERROR(CheckSize("incoming", incoming.size(), 3 * samples));
  IBRDF_RETURN_IF_ERROR(CheckSize("weight", weight.size(), samples));
  if (!irradiance.empty()) {
    IBRDF_RETURN_IF_ERROR(CheckSize("irradiance", irradiance.size(),
                                    3 * static_cast<size_t>(num_texels)));
  }
  for (const float w : weight) {
    if (!(w >= 0.0f && w <= 1.0f)) {
      return InvalidInput("weight", "expected numbers in [0, 1]");
    }
  }
  if (!(mean_radiance > 0.0) || !std::isfinite(mean_radiance)) {
    return InvalidInput("mean_radiance", "expected a finite number > 0");
  }
  if (!(prefilter_alpha >= 0.0 && prefilter_alpha <= 1.0)) {
    return InvalidInput("prefilter_alpha", "expected a number in [0, 1]");
  }
  return OkStatus();
}

float UsableWeight(const TexelSamples& samples, int64_t texel, int view,
                   float scale) {
  const size_t at = static_cast<size_t>(texel) * samples.num_views + view;
  const float* const w = &samples.directions[3 * at];
  const bool above = w[2] > 0.0f && w[2] <= 1.01f && std::abs(w[0]) <= 1.01f &&
                     std::abs(w[1]) <= 1.01f;
  if (!above || !Measured(&samples.outgoing[3 * at], scale) ||
      !Measured(&samples.incoming[3 * at], scale)) {
    return 0.0f;
  }
  return samples.weight[at];
}

}  // namespace ibrdf
