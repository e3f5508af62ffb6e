// Results of each of several views.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/report/result_preview.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// A view whose camera is off fits far worse than the others: by this factor
// more than their median, and by more than kLargeMisfit.
inline constexpr double kOddView = 2.0;
// Those; empty: none is.
std::vector<ViewMisfit> OddViews(const std::vector<ViewMisfit>& views);

// What WriteViews may write, for CheckNothingReplaced.
std::vector<std::string> ViewPaths(const ViewSheet& sheet,
                                   const std::string& folder);

// Writes, for each view of a sheet, its own part of render.exr, residual.exr,
// albedo.exr, gloss.exr and albedo_log_std.exr, and their pictures
// (WriteResultPreviews).
// all: PreviewInput of the solved problem.
Status WriteViews(const SolvedProblem& solved, const ResultPreviewInput& all,
                  const std::string& folder);

// The files that painted objects alone have, beside each view's results and the
// sheet's.
const std::vector<std::string>& PaintFiles();

}  // namespace ibrdf
