// The files that a solve leaves for its user.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/problem/inverse_problem.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// What WriteResults takes on one core of 2.5 GHz.
double PredictWriteSeconds(const InverseProblem& inverse);

// What WriteResults may write for the problem.
std::vector<std::string> ResultPaths(const Problem& problem,
                                     const PhotographedObject& object,
                                     const std::string& folder);

// Writes brdf.binary, brdf.json, illumination.exr, illumination_log_std.exr
// and illumination_variance_left.exr (where a search found them), render.exr,
// residual.exr, the PNG previews, next_views.json (where some were chosen),
// result.json and, last, report.html into `folder`, making it; each file whole
// or absent. Images are the sheet's where there are several views, and each
// view's are in views/NAME. The .exr maps are in the problem's output frame,
// those of pictures in the frame camera.
// result.json and report.html of an earlier run go first: where one is, all
// else is of its run but the files of the look (write_check.h), which are of
// the run that was begun last.
Status WriteResults(const SolvedProblem& solved, const std::string& folder);

}  // namespace ibrdf
