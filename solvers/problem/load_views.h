// The views of a problem, from its list or another program's file.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

// Before images of width x height, pixels. Without `views`: none. Messages name
// the file, and the view where its proportions are not the image's.
StatusOr<std::vector<ViewSpec>> LoadViews(const Problem& problem, int width,
                                          int height);

}  // namespace ibrdf
