// The metrics of a result and what they mean.
#pragma once
#include <string>

#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/report/result_metrics.h"

namespace ibrdf {

// A <section>.
std::string MetricsSection(const ResultMetrics& metrics, ProblemKind kind);

}  // namespace ibrdf
