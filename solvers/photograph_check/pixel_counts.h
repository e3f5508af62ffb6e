// How many of the object's pixels are worth what.
#pragma once
#include <cstddef>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// Pixels of the object by what the worst of their channels is, in this order:
// the kinds after `used` make up the rest of `object`.
struct ObjectPixelCounts {
  size_t object = 0;
  size_t used = 0;        // finite and > 0 in all channels
  size_t clipped = 0;     // codes without an upper end
  size_t not_finite = 0;  // NaN or infinite, in a file of floats
  size_t negative = 0;
  size_t zero = 0;
};

enum class PixelKind { kUsed, kClipped, kNotFinite, kNegative, kZero };

// `codes`: the file held whole numbers, so that NaN stands for a clipped one.
PixelKind KindOfPixel(const float* radiance, bool codes);

// Counts the pixels of these points, which have at most one each.
ObjectPixelCounts CountPixels(const Image& radiance,
                              const std::vector<ShadingPoint>& points,
                              bool codes);

}  // namespace ibrdf
