// Normals of a surface that is given by its depth in each pixel.
#pragma once
#include <cstddef>
#include <vector>

#include "ibrdf/geometry/camera.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Along the view, growing away from the camera: the plane's distance, not the
// ray's. Before an orthographic camera in pixels' sides, before a perspective
// one in any unit. Not finite: a hole.
struct DepthMap {
  int width = 0, height = 0;
  std::vector<double> depth;  // [height * width]
};

struct DepthNormals {
  Image normals;        // the camera's frame, as NormalMap; zero: outside
  size_t known = 0;     // pixels that have a depth
  size_t isolated = 0;  // of them without a neighbour along x or along y
};

// By central differences of positions. At holes, at the image's border and
// where depth jumps, the difference to the one neighbour on the same surface is
// taken. Of the camera, type and fov_degrees are used.
DepthNormals NormalsOfDepth(const DepthMap& map, const Camera& camera);

}  // namespace ibrdf
