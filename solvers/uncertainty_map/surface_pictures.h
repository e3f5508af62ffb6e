// Values of texels as pictures: the texture, and what a view shows of it.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/geometry/camera.h"
#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/surface/surface_atlas.h"

namespace ibrdf {

// Rows of atlas.texels, -1 where a pixel shows none of the surface.
struct TexelRows {
  int width = 0, height = 0;
  std::vector<int32_t> row;  // [height * width]

  Mask Covered() const;
};

TexelRows RowsOfTexture(const SurfaceAtlas& atlas);
// The row of the texel at each pixel's centre; texture: RowsOfTexture of the
// scene's atlas.
TexelRows RowsOfView(const Scene& scene, const TexelRows& texture,
                     const Camera& camera, int width, int height,
                     int num_threads);

// values [num_texels, channels]: three, or one for all. NaN where there is no
// texel.
Image PictureOf(const TexelRows& rows, const std::vector<float>& values,
                int channels);

}  // namespace ibrdf
