// check.png: the look before a solve as one picture.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/problem/load_object.h"

namespace ibrdf {

// What the picture shows; borrowed for the call.
struct CheckPictureInput {
  std::string title;
  const Image& radiance;
  const std::vector<ShadingPoint>& points;
  const ObjectLook& look;
  // The known light as a mirror ball shows it, a square of linear display
  // colours; empty: none.
  Image mirror_ball;
};

// 1560 pixels wide: the photograph with the mask's outline, normals as colours
// and under a lamp, mask and shape; what takes no part, colours among like
// normals, the verdicts; of a normal map, a lit object for each hypothesis.
Rgb8Image DrawCheck(const CheckPictureInput& input);

}  // namespace ibrdf
