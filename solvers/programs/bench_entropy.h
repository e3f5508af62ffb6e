// The experiments `entropy` and `best-view` of ibrdf_bench.
#pragma once
#include "ibrdf/solvers/programs/bench_session.h"

namespace ibrdf {

void AddEntropyExperiments(CLI::App* app, BenchSession* session);

}  // namespace ibrdf
