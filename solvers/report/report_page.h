// report.html: a result to look at, on one page without other files.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/report/report_figures.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// A whole HTML page, well-formed XML too, without scripts or links to load.
// What the solution lacks is left out; numbers that are not finite are shown as
// "-". Fails on a picture that no PNG can hold.
StatusOr<std::string> ReportPage(const SolvedProblem& solved,
                                 const std::vector<ReportGroup>& groups);

}  // namespace ibrdf
