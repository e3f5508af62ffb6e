#include "ibrdf/solvers/drawing/crop.h"

#include <glog/logging.h>

#include <algorithm>

namespace ibrdf {
namespace {

void CheckBox(const PixelBox& box, int width, int height) {
  CHECK(box.left >= 0 && box.top >= 0);
  CHECK(box.width > 0 && box.height > 0);
  CHECK(box.left + box.width <= width && box.top + box.height <= height);
}

}  // namespace

PixelBox BoxAround(const Mask& mask, int width, int height) {
  constexpr int kMarginOf = 20;
  int left = width, right = -1, top = height, bottom = -1;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (mask.inside[static_cast<size_t>(y) * mask.width + x] == 0) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  if (right < left) return {0, 0, width, height};
  const int margin =
      std::max(1, std::max(right - left, bottom - top) / kMarginOf);
  left = std::max(left - margin, 0);
  top = std::max(top - margin, 0);
  right = std::min(right + margin, width - 1);
  bottom = std::min(bottom + margin, height - 1);
  return {left, top, right - left + 1, bottom - top + 1};
}

Image Crop(const Image& image, const PixelBox& box) {
  CheckBox(box, image.width, image.height);
  Image out(box.width, box.height);
  for (int y = 0; y < box.height; ++y) {
    const float* const row = image.At(box.left, box.top + y);
    std::copy(row, row + size_t{3} * box.width, out.At(0, y));
  }
  return out;
}

Mask Crop(const Mask& mask, const PixelBox& box) {
  if (mask.empty()) return mask;
  CheckBox(box, mask.width, mask.height);
  Mask out(box.width, box.height, 0);
  for (int y = 0; y < box.height; ++y) {
    const auto row = mask.inside.begin() +
                     static_cast<std::ptrdiff_t>(box.top + y) * mask.width +
                     box.left;
    std::copy(row, row + box.width,
              out.inside.begin() + static_cast<std::ptrdiff_t>(y) * box.width);
  }
  return out;
}

}  // namespace ibrdf
