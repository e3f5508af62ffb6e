// Cameras that photographs might be taken from.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/solvers/uncertainty_map/uncertainty_inputs.h"

namespace ibrdf {

inline constexpr int kMostCandidates = 1000;

// "sphere:N": N pinholes about the surface, on a Fibonacci sphere, that look at
// its middle from the mean distance of the photographs', with the first one's
// lens and size; where none is a pinhole, far enough to see all of it. Else a
// file of transforms, or a folder of COLMAP's model, of the world that `up` is
// of. 1 to kMostCandidates.
StatusOr<std::vector<CalibratedView>> LoadCandidates(
    const std::string& text, const UncertaintyInputs& inputs,
    UpAxis up = UpAxis::kY);

// The candidate's camera before an image of its own proportions or, where it
// has none, of `aspect` = width / height.
struct SizedCamera {
  Camera camera;
  int width = 0, height = 0;
};
StatusOr<SizedCamera> CandidateCamera(const CalibratedView& candidate,
                                      double aspect, int short_side);

}  // namespace ibrdf
