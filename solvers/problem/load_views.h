// The views of a problem, from its list or another program's file.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

// Those of another program's file, transforms or else COLMAP's model, in the
// library's world: `up` is of the file's.
StatusOr<std::vector<CalibratedView>> ReadCalibratedViews(
    const std::string& transforms, const std::string& colmap, UpAxis up);

// Before images of width x height, pixels. Without `views`: none. Messages name
// the file, and the view where its proportions are not the image's.
StatusOr<std::vector<ViewSpec>> LoadViews(const Problem& problem, int width,
                                          int height);

}  // namespace ibrdf
