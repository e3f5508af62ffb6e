// A principled reflectance that varies over the surface.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/disney.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

class KnownTexture {
 public:
  // Reads the textures: floats as they are, codes of a PNG over the largest,
  // those of the base colour decoded as sRGB. Refuses values out of the keys'
  // ranges, and colour where one number is meant. wrap_u: the left and right
  // borders meet, as on a sphere.
  static StatusOr<KnownTexture> Load(const PrincipledSpec& spec, bool wrap_u);

  Disney At(const Eigen::Vector2f& uv) const;
  // The same of points; *this must outlive it.
  SurfaceBrdf Brdf() const;
  // The mean values over the points.
  Disney Mean(const std::vector<ShadingPoint>& points) const;
  // The first of the points with the least roughness.
  Disney Sharpest(const std::vector<ShadingPoint>& points) const;

 private:
  // A texture, or one texel.
  Image base_, roughness_, metallic_, specular_;
  bool wrap_u_ = false;
};

}  // namespace ibrdf
