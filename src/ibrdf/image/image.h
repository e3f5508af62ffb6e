// Linear RGB images and masks in memory.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ibrdf {

// Linear radiance, W/(m^2 sr). Interleaved RGB, row 0 is the top row.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<float> rgb;  // [height * width * 3]

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), rgb(static_cast<size_t>(w) * h * 3, 0.0f) {}

  bool empty() const { return rgb.empty(); }
  size_t num_pixels() const { return static_cast<size_t>(width) * height; }
  float* At(int x, int y) {
    return rgb.data() + (static_cast<size_t>(y) * width + x) * 3;
  }
  const float* At(int x, int y) const {
    return rgb.data() + (static_cast<size_t>(y) * width + x) * 3;
  }
};

// "128x64", for messages.
inline std::string SizeName(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

// Pixels that belong to the object: nonzero = inside.
struct Mask {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> inside;  // [height * width]

  Mask() = default;
  Mask(int w, int h, uint8_t value)
      : width(w), height(h), inside(static_cast<size_t>(w) * h, value) {}

  bool empty() const { return inside.empty(); }
  // An empty mask holds every pixel.
  bool Holds(size_t pixel) const { return empty() || inside[pixel] != 0; }
  size_t CountInside() const {
    size_t n = 0;
    for (const uint8_t v : inside) n += v != 0;
    return n;
  }
};

}  // namespace ibrdf
