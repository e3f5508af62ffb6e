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

// How much the points of a pair say of each other, in (0, 1]: 1 where their
// normals are alike, a half at a crease of 0.05 radians.
double WeightOfTurn(double turn);

}  // namespace ibrdf
