// How far a rendered image is from a reference.
#pragma once
#include <cstdint>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Over the pixels inside the mask whose reference is finite, and the three
// channels; e the estimate, r the reference.
struct ImageMetrics {
  // Root mean square of log(max(e, 0) + f) - log(max(r, 0) + f), natural
  // logarithm, f = 1e-6 times the largest reference value.
  double log_rmse = 0.0;
  // Mean magnitude of the same.
  double mean_abs_log = 0.0;
  // 20 log10(largest r / root mean square of s e - r), dB, with the one s >= 0
  // for all channels that makes it largest; infinite where nothing is left.
  double psnr = 0.0;
  // (1 - SSIM) / 2 of log(1 + max(x, 0)) as they are, in [0, 1]: the mean over
  // pixels and channels. Window 11x11, Gaussian of sigma 1.5 pixels, cut to the
  // pixels compared and normalised again, so that nothing outside leaks in.
  // C1 = (0.01 D)^2, C2 = (0.03 D)^2, D the largest log(1 + r)
  // (Wang et al. 2004).
  double dssim = 0.0;
  int64_t pixels = 0;
};

// An empty mask takes all pixels. Refuses images and a mask of different sizes,
// no pixel to compare, a reference that is nowhere > 0, and an estimate that is
// not finite at a pixel compared. The message starts with "estimate",
// "reference" or "mask".
StatusOr<ImageMetrics> CompareImages(const Image& estimate,
                                     const Image& reference, const Mask& mask);

}  // namespace ibrdf
