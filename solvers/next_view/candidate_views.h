// Cameras that photographs might be taken from.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

inline constexpr int kMostCandidates = 1000;
inline constexpr char kNextViewsFile[] = "next_views.json";

// A camera before an image of its own.
struct SizedCamera {
  Camera camera;
  int width = 0, height = 0;  // pixels
};

// What candidates are placed by.
struct CandidateSetting {
  // A ball about the surface.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;
  std::vector<SizedCamera> photographs;  // one or more
};

// "sphere:N": N pinholes about the surface, on a Fibonacci sphere, that look at
// its middle from the mean distance of the photographs', with the first one's
// lens and size; where none is a pinhole, far enough to see all of it. Else a
// file of transforms, or a folder of COLMAP's model, of the world that `up` is
// of. 1 to kMostCandidates.
StatusOr<std::vector<CalibratedView>> LoadCandidates(
    const std::string& text, const CandidateSetting& setting,
    UpAxis up = UpAxis::kY);

// The candidate's camera before an image of its own proportions or, where it
// has none, of `aspect` = width / height.
StatusOr<SizedCamera> CandidateCamera(const CalibratedView& candidate,
                                      double aspect, int short_side);

// `count` candidates by farthest-point sampling of directions from `middle`,
// away from the photographs'.
std::vector<int> FarthestCandidates(
    const std::vector<CalibratedView>& candidates,
    const std::vector<SizedCamera>& photographs, const Eigen::Vector3d& middle,
    int count);

// next_views.json, a file of transforms, of some candidates, in a world of this
// up axis.
std::string NextViewsText(const std::vector<CalibratedView>& candidates,
                          const std::vector<int>& chosen, UpAxis up);

}  // namespace ibrdf
