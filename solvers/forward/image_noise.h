// Noise of rendered images.
#pragma once
#include <cstdint>

#include "ibrdf/image/image.h"

namespace ibrdf {

// Multiplies each channel of each pixel by exp(sigma * normal), row-major; the
// same seed gives the same noise anywhere.
void AddNoise(double sigma, uint64_t seed, Image* image);

}  // namespace ibrdf
