// The experiments of ibrdf_bench that run the solver over materials and maps:
// joint, known-light, known-brdf and pareto.
#pragma once
#include "ibrdf/solvers/programs/bench_session.h"

namespace CLI {
class App;
}  // namespace CLI

namespace ibrdf {

void AddSolverExperiments(CLI::App* app, BenchSession* session);

}  // namespace ibrdf
