// The photographs of several views, each with its camera.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

struct PhotographedView {
  std::string name;  // a folder's
  std::string file;
  Camera camera;
  // As Photograph's; NaN where codes are clipped.
  Image radiance;
  Mask mask;  // of the object; empty: all pixels
};

// The views of CheckTextures, in the order of the problem, or of its file.
// problem.image has the curve of all. Warnings that views share are told once.
StatusOr<std::vector<PhotographedView>> LoadPhotographedViews(
    const Problem& problem, std::vector<std::string>* warnings);

}  // namespace ibrdf
