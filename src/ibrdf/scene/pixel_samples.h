// Which pixels one sample at the centre does not stand for: those that the
// image bends or breaks at, by its second differences.
#pragma once
#include <vector>

#include "ibrdf/image/image.h"

namespace ibrdf {

// Expected |log L_o - log mean of L_o over the pixel|, mean of the channels, of
// radiance L_o at the pixel's centre; 0 outside the mask. Radiance below 1e-3
// of the image's mean counts as that.
std::vector<double> CentreErrors(const Image& image, const Mask& mask);

// The fewest pixels without whose errors the mean over the mask is at most
// `log_error`. Empty: none.
Mask PixelsToSample(const Image& image, const Mask& mask, double log_error);

}  // namespace ibrdf
