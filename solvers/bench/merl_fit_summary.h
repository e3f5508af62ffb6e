// Means and comparisons of the rows of the sweep `merl-fit`.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/solvers/bench/results_table.h"

namespace ibrdf {

// Markdown from rows of MerlFitColumns() whose status is ok: mean, median and
// largest score of each method (with its lobes, model and, where there are
// several, seed) over all materials and over those but the four whose stand-in
// tables sit on a floor; then on how many materials one method's log-RMSE is
// below another's, out of those that both have.
std::string SummarizeMerlFits(const std::vector<ResultsRow>& rows);

}  // namespace ibrdf
