// The files of a map of uncertainty.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/uncertainty_map/map_uncertainty.h"

namespace ibrdf {

// Into a folder that exists, each whole or absent: entropy.exr and .png (of the
// texture, and in views/NAME of each view), alpha.exr, ks.exr,
// below_band_limit.png, observed_views.exr, result.json, report.html, and
// next_views.json where views were chosen. Maps are NaN where there is no
// surface. Refuses to replace a file that the problem or its views name.
// result.stages gets the seconds of the pictures.
Status WriteUncertainty(const Problem& problem,
                        const UncertaintyOptions& options,
                        const std::string& out_dir, UncertaintyResult* result);

}  // namespace ibrdf
