// The files that a solve leaves for its user.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"
#include "ibrdf/solvers/problem/truth.h"

namespace ibrdf {

// What WriteResults takes on one core of 2.5 GHz.
double PredictWriteSeconds(const InverseProblem& inverse);

// What WriteResults may write for the problem.
std::vector<std::string> ResultPaths(const Problem& problem,
                                     const std::string& folder);

// Writes result.json, brdf.binary, brdf.json, illumination.exr,
// illumination_log_std.exr (where a search found it), render.exr, residual.exr,
// the PNG previews and, last, report.html into `folder`, making it; each file
// whole or absent. result.json and report.html of an earlier run go first:
// where one is, all else is of its run. `metrics_text`, where given, receives
// the metrics, one a line.
Status WriteResults(const Problem& problem, const InverseProblem& inverse,
                    const Truth& truth, const Solution& estimate,
                    const std::string& folder, std::string* metrics_text);

}  // namespace ibrdf
