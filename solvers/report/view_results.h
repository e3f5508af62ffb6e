// Results of each of several views.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

struct ViewMisfit {
  std::string name;
  size_t pixels = 0;  // that took part
  // Mean |log render - log input| of them; NaN where there is none.
  double misfit = std::numeric_limits<double>::quiet_NaN();
};

// By view, in the sheet's order; empty: one photograph.
std::vector<ViewMisfit> MisfitOfViews(const InverseProblem& inverse,
                                      const Solution& solution);

// A view whose camera is off fits far worse than the others: by this factor
// more than their median, and by more than kLargeMisfit.
inline constexpr double kOddView = 2.0;
// Those; empty: none is.
std::vector<ViewMisfit> OddViews(const std::vector<ViewMisfit>& views);

// The folder of a view's results: folder/views/NAME.
std::string ViewFolder(const std::string& folder, const std::string& name);

// What WriteViews may write, for CheckNothingReplaced.
std::vector<std::string> ViewPaths(const ViewSheet& sheet,
                                   const std::string& folder);

// Of each view of a sheet, its own part of render.exr, residual.exr, albedo.exr
// and gloss.exr, and their pictures (WriteResultPreviews).
Status WriteViews(const SolvedProblem& solved, const std::string& folder);

}  // namespace ibrdf
