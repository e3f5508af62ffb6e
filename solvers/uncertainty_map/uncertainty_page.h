// report.html of a map of uncertainty.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/uncertainty_map/map_uncertainty.h"
#include "ibrdf/solvers/uncertainty_map/surface_pictures.h"

namespace ibrdf {

// One value a texel, in [0, high]: white is 0, dark red `high`; grey shows no
// surface.
Rgb8Image DrawTexels(const TexelRows& rows, const std::vector<float>& values,
                     double high, int max_side);

// views: RowsOfView of the first of result.inputs.views, those that are shown.
StatusOr<std::string> UncertaintyPage(const Problem& problem,
                                      const UncertaintyResult& result,
                                      const TexelRows& texture,
                                      const std::vector<TexelRows>& views);

}  // namespace ibrdf
