// Pixels beside each other.
#pragma once
#include <vector>

#include "ibrdf/scene/scene.h"

namespace ibrdf {

struct NeighbourPair {
  int first = 0, second = 0;  // points
  double turn = 0.0;          // |difference of the normals|
};

// The points of pixels that share a side. image_width > 0, pixels.
std::vector<NeighbourPair> NeighboursOf(const std::vector<ShadingPoint>& points,
                                        int image_width);

}  // namespace ibrdf
