// Flags that the sweeps over images share.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/held_out_models.h"
#include "ibrdf/solvers/bench/solver_sweep.h"
#include "ibrdf/solvers/programs/bench_session.h"

namespace CLI {
class App;
}  // namespace CLI

namespace ibrdf {

struct SweepFlags {
  OnlyFlag only;
  bool dry_run = false;

  // Completes options from these and the session's flags.
  Status Apply(const BenchSession& session, SweepOptions* options);
};

void AddSweepFlags(CLI::App* app, SweepOptions* options, SweepFlags* flags);

void AddSolverFlags(CLI::App* app, SolverSweepOptions* options);

void AddModelFlags(CLI::App* app, ModelOptions* options, int* lobes);

// Where no program of the solver was given: ibrdf_solve beside this program.
void FindSolver(SolverSweepOptions* options);

// Prints one line a run: case, table, map, folder of the estimate.
Status PrintRuns(const std::vector<SolverRun>& runs);

}  // namespace ibrdf
