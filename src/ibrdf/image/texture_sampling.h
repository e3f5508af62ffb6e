// Lookups in textures over a surface.
#pragma once
#include <Eigen/Core>

#include "ibrdf/image/image.h"

namespace ibrdf {

// Bilinear between the centres of texels; (0, 0) is the bottom left corner of
// the picture, (1, 1) the top right one. At the borders the outer texels go on
// or, with `wrap_u`, left and right meet. `texture` is not empty, uv finite.
Eigen::Array3f SampleTexture(const Image& texture, const Eigen::Vector2f& uv,
                             bool wrap_u);

}  // namespace ibrdf
