// How far an estimated environment map is from a reference.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Root mean squares of log(max(L, 0) + f) - log(max(L_ref, 0) + f), natural
// logarithm, f = 1e-6 times the reference's largest value, divided by the
// reference's range log(max + f) - log(min + f); largest, max and min over all
// texels and channels, negative radiance as 0.
struct IlluminationMetrics {
  double relative_log_rmse = 0.0;  // weighted by solid angle
  // The weighted mean difference of each channel taken off first: the best
  // scale per channel but for the floor, which is not scaled.
  double relative_log_rmse_aligned = 0.0;
  double relative_log_rmse_unweighted = 0.0;  // every texel the same
};

// Equirectangular maps of one size. Refuses maps of different sizes, a constant
// reference (its range is 0) and non-finite radiance. The message starts with
// "reference" or "estimate".
StatusOr<IlluminationMetrics> CompareIlluminations(const Image& estimate,
                                                   const Image& reference);

}  // namespace ibrdf
