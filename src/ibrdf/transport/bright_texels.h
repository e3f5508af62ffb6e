// Few texels far brighter than the rest of a map, and directions that stand for
// them: rings around a mirrored view (PointQuadrature) may miss a small sun.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"

namespace ibrdf {

struct BrightTexel {
  int row, column;
  Eigen::Array3d excess;  // radiance
};

struct BrightTexels {
  std::vector<BrightTexel> texels;
  Image rest;  // the map less their excess, of the same colour
};

// At most 32 texels, by what they have above the brightest of the others or 30
// times the map's mean; none where that is less than 0.2 % of all light, nor in
// maps of texels of more than 4 degrees, which no rings miss.
BrightTexels SplitBrightTexels(const Image& map);

// Their light is linear between texel centres, as LookUpMap has it.
struct BrightSample {
  Eigen::Vector3d direction;  // unit
  Eigen::Array3d power;       // radiance times solid angle
};

// per_side^2 directions a texel, which neighbours share; per_side even.
std::vector<BrightSample> SampleBrightTexels(
    const std::vector<BrightTexel>& texels, int map_height, int map_width,
    int per_side);

}  // namespace ibrdf
