#include "ibrdf/transport/map_sources.h"

#include <algorithm>

#include "ibrdf/light/environment_map.h"

namespace ibrdf {

std::vector<float> SumBlocks(const float* map, int height, int width,
                             int block) {
  const int columns = width / block, rows = height / block;
  std::vector<double> sums(size_t{3} * rows * columns, 0.0);
  for (int y = 0; y < height; ++y) {
    const double solid_angle = TexelSolidAngle(y, height, width);
    for (int x = 0; x < width; ++x) {
      const float* from = map + 3 * (static_cast<size_t>(y) * width + x);
      const size_t to = static_cast<size_t>(y / block) * columns + x / block;
      for (int c = 0; c < 3; ++c) sums[3 * to + c] += solid_angle * from[c];
    }
  }
  std::vector<float> out(size_t{4} * rows * columns, 0.0f);
  for (size_t b = 0; b < sums.size() / 3; ++b) {
    for (int c = 0; c < 3; ++c) {
      out[4 * b + c] = static_cast<float>(sums[3 * b + c]);
    }
  }
  return out;
}

std::vector<int> PaddedTexels(int height, int width) {
  std::vector<int> texel;
  for (int y = -1; y <= height; ++y) {
    const bool across = y < 0 || y == height;
    const int r = std::clamp(y, 0, height - 1);
    for (int x = 0; x <= width; ++x) {
      texel.push_back(r * width + (x + (across ? width / 2 : 0)) % width);
    }
  }
  return texel;
}

}  // namespace ibrdf
