// A problem file from its inputs to its results.
#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "io/problem.h"
#include "solvers/inverse_rendering.h"
#include "solvers/truth.h"

namespace ibrdf {

// Reads every file that a checked problem names and finds the object's pixels.
StatusOr<InverseProblem> LoadInverseProblem(const Problem& problem,
                                            uint64_t default_seed,
                                            int num_threads);

// What WriteResults takes on one core of 2.5 GHz.
double PredictWriteSeconds(const InverseProblem& inverse);

// Makes `folder` where need be; kInvalidInput where nothing can be written to
// it. Call it before a solve.
Status PrepareFolder(const std::string& folder);

// What WriteResults may write for the problem.
std::vector<std::string> ResultPaths(const Problem& problem,
                                     const std::string& folder);

// kInvalidInput where one of the paths is a file that the problem names, which
// a result would replace. Call it before a solve or a render.
Status CheckNothingReplaced(const Problem& problem,
                            const std::vector<std::string>& paths);

// Writes result.json, brdf.binary, brdf.json, illumination.exr,
// illumination_log_std.exr (where a search found it), render.exr, residual.exr,
// the PNG previews and, last, report.html into `folder`, making it; each file
// whole or absent. result.json and report.html of an earlier run go first:
// where one is, all else is of its run. `metrics_text`, where given, receives
// the metrics, one a line.
Status WriteResults(const Problem& problem, const InverseProblem& inverse,
                    const Truth& truth, const Estimate& estimate,
                    const std::string& folder, std::string* metrics_text);

}  // namespace ibrdf
