// The photographs of several views, each with its camera.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/problem/load_photograph.h"

namespace ibrdf {

struct PhotographedView {
  std::string name;  // a folder's
  std::string file;
  Camera camera;
  // As Photograph's; NaN where codes are clipped.
  Image radiance;
  Mask mask;  // of the object; empty: all pixels
};

// A photograph before its curve's gaps are settled (PhotographedView).
struct ViewPhotograph {
  std::string name;        // a folder's
  std::string file, mask;  // mask empty: none
  Camera camera;
  Photograph photograph;
};

// Reads the views of a problem one by one, in its order or its file's, and
// hands each to `take`; ends at the first failure. problem.image has the curve
// of all. Warnings that views share are told once.
Status ReadViewPhotographs(const Problem& problem,
                           const std::function<Status(ViewPhotograph)>& take,
                           std::vector<std::string>* warnings);

// The views of CheckTextures, in the order of the problem, or of its file.
// problem.image has the curve of all. Warnings that views share are told once.
StatusOr<std::vector<PhotographedView>> LoadPhotographedViews(
    const Problem& problem, std::vector<std::string>* warnings);

}  // namespace ibrdf
