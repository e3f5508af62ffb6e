// The experiment `entropy`: evaluators beside brute force.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/entropy_study/study_cases.h"

namespace ibrdf {

// Columns of its results.csv, in order; the first three name the row.
const std::vector<std::string>& EntropyColumns();

// For each scene a row of the trivial predictor (minus the logarithm of the
// outgoing radiance's power), of Laplace's approximation, and of every variant
// of the evaluators: how its entropy goes with that of brute force. Rows that
// out/results.csv holds are not made again. Then writes out/results.md.
Status RunEntropySweep(const StudyOptions& options);

}  // namespace ibrdf
