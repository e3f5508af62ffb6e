// How far the albedo of an object's pixels is from a reference.
#pragma once
#include <cstdint>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Over the pixels inside the mask where both have three channels > 0; e the
// estimate, r the reference. Aligned: after the scale of each channel that
// brings the mean of log e to that of log r, as one image leaves it open.
struct AlbedoMapMetrics {
  // Root mean square of log e - log r, natural logarithm.
  double log_rmse = 0.0, log_rmse_aligned = 0.0;
  // As ImageMetrics, aligned.
  double psnr = 0.0, dssim = 0.0;
  // Local mean squared error of the channels' mean: over windows of 20 pixels
  // at steps of 10, sum |s e - r|^2 with the best s of each window, divided by
  // the same sum of |r|^2 (Grosse et al., ICCV 2009, Sec. 4). In [0, 1].
  double lmse = 0.0;
  int64_t pixels = 0;
};

// An empty mask takes all pixels. Refuses images and a mask of different sizes,
// and no pixel to compare. The message starts with "estimate", "reference" or
// "mask".
StatusOr<AlbedoMapMetrics> CompareAlbedoMaps(const Image& estimate,
                                             const Image& reference,
                                             const Mask& mask);

}  // namespace ibrdf
