// Maps in planes, at another size.
#pragma once
#include <vector>

#include "ibrdf/image/image.h"

namespace ibrdf {

struct MapSize {
  int width = 0, height = 0;

  bool operator==(const MapSize& o) const {
    return width == o.width && height == o.height;
  }
  bool operator!=(const MapSize& o) const { return !(*this == o); }
};

// [channels][to.height][to.width] of equirectangular planes
// [channels][from.height][from.width], bilinear between their texels' centres.
std::vector<float> ResamplePlanes(const std::vector<float>& planes,
                                  MapSize from, MapSize to);

// The image [H, W, 3] of planes [3][H][W].
Image ImageOfPlanes(const std::vector<double>& planes, int width, int height);

}  // namespace ibrdf
