// Display-ready 8-bit images (previews, plots).
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ibrdf {

// Interleaved sRGB-encoded RGB, row 0 is the top row.
struct Rgb8Image {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgb;  // [height * width * 3]

  Rgb8Image() = default;
  Rgb8Image(int w, int h)
      : width(w), height(h), rgb(static_cast<size_t>(w) * h * 3, 0) {}

  bool empty() const { return rgb.empty(); }
  uint8_t* At(int x, int y) {
    return rgb.data() + (static_cast<size_t>(y) * width + x) * 3;
  }
  const uint8_t* At(int x, int y) const {
    return rgb.data() + (static_cast<size_t>(y) * width + x) * 3;
  }
};

}  // namespace ibrdf
