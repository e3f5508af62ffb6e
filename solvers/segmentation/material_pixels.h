// An object's pixels as they tell its materials apart before its light is
// known: log colours by normals, and who is beside whom.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"

namespace ibrdf {

// Two pixels beside each other, by a side or a corner.
struct PixelPair {
  int first = 0, second = 0;
  bool by_side = false;
  // How much one's material says of the other's, >= 0: more where their
  // colours are alike.
  double alike = 0.0;
};

struct MaterialPixels {
  // The pixel of each point; -1: it takes no part.
  std::vector<int> pixel_of_point;
  Eigen::MatrixX3d normals;  // [pixels], unit, world
  // Log radiance [pixels]: luminance, then chroma on two orthogonal axes.
  Eigen::MatrixX3d colours;
  // Log radiance [pixels] by channel, without noise and with edges (a bilateral
  // filter).
  Eigen::MatrixX3d smooth;
  std::vector<PixelPair> neighbours;

  int count() const { return static_cast<int>(normals.rows()); }
};

// Blocks of `block` times `block` pixels of the image, their points' means, as
// one. Points take part that are valid and away from the limb, as in searches;
// blocks of which half of the pixels do. image_width, block: > 0.
MaterialPixels GatherPixels(const std::vector<ShadingPoint>& points,
                            const Observations& observed, int image_width,
                            int block);

}  // namespace ibrdf
