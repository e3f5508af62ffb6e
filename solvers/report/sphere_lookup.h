// A picture of a sphere as the radiance of its normals: other shapes of the
// same material in the same light.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// `sphere`: square, of the unit sphere from edge to edge, seen by the
// orthographic camera, as RenderBrdfSphere makes it. Borrows it.
class SphereLookup {
 public:
  explicit SphereLookup(const Image& sphere);

  // Radiance of a normal with these two components to the right and up: linear
  // between the pixels whose centre shows the sphere, beyond the outermost of
  // them the nearest one's. right^2 + up^2 <= 1.
  Eigen::Array3f At(double right, double up) const;

 private:
  bool Shows(int column, int row) const;

  const Image& sphere_;
};

// The sphere in size x size pixels; 0 where a pixel's centre does not show it.
Image ResizeSphere(const Image& sphere, int size);

// An object of these points in the sphere's light, which goes with the camera:
// up is up in the picture. Without shadows and bounces. 0 elsewhere.
Image RelitObject(const Image& sphere, const std::vector<ShadingPoint>& points,
                  int width, int height);

}  // namespace ibrdf
