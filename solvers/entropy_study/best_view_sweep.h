// The experiment `best-view`: searches for views beside farthest points.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/entropy_study/study_cases.h"

namespace ibrdf {

// Columns of its results.csv, in order; the first three name the row.
const std::vector<std::string>& BestViewColumns();

// From ten farthest points on to twenty views. For each scene a row of every
// search: with how many views it has the mean entropy of brute force of twenty
// farthest points, and entropy and error of twenty views. Rows that
// out/results.csv holds are not made again. Then writes out/results.md, with
// paired t tests of the entropies.
Status RunBestViewSweep(const StudyOptions& options);

}  // namespace ibrdf
