// The part of an image that shows the object.
#pragma once
#include "ibrdf/image/image.h"

namespace ibrdf {

// Columns [left, left + width), rows [top, top + height).
struct PixelBox {
  int left = 0, top = 0, width = 0, height = 0;
};

// The box around the mask's pixels with a twentieth of its longer side, a pixel
// at least, on every side where the image has it. All of the image where the
// mask holds none, or is empty.
PixelBox BoxAround(const Mask& mask, int width, int height);

// `box` lies in the image; an empty mask stays empty.
Image Crop(const Image& image, const PixelBox& box);
Mask Crop(const Mask& mask, const PixelBox& box);

}  // namespace ibrdf
