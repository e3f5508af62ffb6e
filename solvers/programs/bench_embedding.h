// The experiment `embedding` of ibrdf_bench.
#pragma once
#include "ibrdf/solvers/programs/bench_session.h"

namespace CLI {
class App;
}  // namespace CLI

namespace ibrdf {

void AddEmbeddingExperiment(CLI::App* app, BenchSession* session);

}  // namespace ibrdf
