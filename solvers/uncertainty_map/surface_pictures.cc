#include "ibrdf/solvers/uncertainty_map/surface_pictures.h"

#include <algorithm>
#include <limits>

#include "ibrdf/base/parallel_for.h"

namespace ibrdf {

Mask TexelRows::Covered() const {
  Mask mask(width, height, 0);
  for (size_t i = 0; i < row.size(); ++i) mask.inside[i] = row[i] >= 0;
  return mask;
}

TexelRows RowsOfTexture(const SurfaceAtlas& atlas) {
  TexelRows out;
  out.width = atlas.width;
  out.height = atlas.height;
  out.row.assign(static_cast<size_t>(atlas.width) * atlas.height, -1);
  for (size_t i = 0; i < atlas.texels.size(); ++i) {
    out.row[atlas.texels[i].texel] = static_cast<int32_t>(i);
  }
  return out;
}

TexelRows RowsOfView(const Scene& scene, const TexelRows& texture,
                     const Camera& camera, int width, int height,
                     int num_threads) {
  TexelRows out;
  out.width = width;
  out.height = height;
  out.row.assign(static_cast<size_t>(width) * height, -1);
  const bool from_infinity = camera.type == CameraType::kOrthographic;
  ParallelFor(height, num_threads, [&](int64_t y, int) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = CameraRay(camera, x + 0.5, static_cast<double>(y) + 0.5,
                                width, height);
      SurfaceHit hit;
      if (!scene.Intersect(ray, from_infinity, &hit)) continue;
      // Row 0 is v = 1.
      const int column = std::clamp(
          static_cast<int>(hit.texture.x() * static_cast<float>(texture.width)),
          0, texture.width - 1);
      const int row =
          std::clamp(static_cast<int>((1.0f - hit.texture.y()) *
                                      static_cast<float>(texture.height)),
                     0, texture.height - 1);
      out.row[static_cast<size_t>(y) * width + x] =
          texture.row[static_cast<size_t>(row) * texture.width + column];
    }
  });
  return out;
}

Image PictureOf(const TexelRows& rows, const std::vector<float>& values,
                int channels) {
  Image out(rows.width, rows.height);
  for (size_t i = 0; i < rows.row.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      float& v = out.rgb[3 * i + c];
      if (rows.row[i] < 0) {
        v = std::numeric_limits<float>::quiet_NaN();
      } else {
        v = values[static_cast<size_t>(rows.row[i]) * channels +
                   std::min(c, channels - 1)];
      }
    }
  }
  return out;
}

}  // namespace ibrdf
