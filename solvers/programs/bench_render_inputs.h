// The experiment `render-inputs` of ibrdf_bench.
#pragma once
#include "ibrdf/solvers/programs/bench_session.h"

namespace CLI {
class App;
}  // namespace CLI

namespace ibrdf {

void AddRenderInputsExperiment(CLI::App* app, BenchSession* session);

}  // namespace ibrdf
