// Checks of the inputs of metrics between images.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// "(x, y)" of a pixel counted row by row.
inline std::string PixelName(const Image& image, size_t pixel) {
  const size_t width = static_cast<size_t>(image.width);
  return "(" + std::to_string(pixel % width) + ", " +
         std::to_string(pixel / width) + ")";
}

inline Status CheckSameSize(const Image& estimate, const Image& reference) {
  if (reference.empty()) return InvalidInput("reference", "expected pixels");
  if (estimate.width != reference.width ||
      estimate.height != reference.height) {
    return InvalidInput("estimate: size",
                        "expected " +
                            SizeName(reference.width, reference.height) +
                            " as the reference, found " +
                            SizeName(estimate.width, estimate.height));
  }
  return OkStatus();
}

// An empty mask fits any image.
inline Status CheckMaskSize(const Mask& mask, const Image& reference) {
  if (mask.empty() ||
      (mask.width == reference.width && mask.height == reference.height)) {
    return OkStatus();
  }
  return InvalidInput(
      "mask: size", "expected " + SizeName(reference.width, reference.height) +
                        " as the reference, found " +
                        SizeName(mask.width, mask.height));
}

}  // namespace ibrdf
