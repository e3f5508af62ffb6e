// The sweep `pareto`: what accuracy costs in time. Joint estimates of the same
// cases, one setting of the solver changed at a time.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/model_sweep.h"

namespace ibrdf {

struct ParetoSweepOptions : ModelSweepOptions {
  ParetoSweepOptions() { solver_seconds = 60.0; }

  std::vector<std::string> settings;  // by name; empty: all
};

// All names, comma-separated.
std::string ParetoSettingNames();

// Columns of its results.csv, in order; all before `seconds` name the run. Maps
// are compared at the size that the other sweeps estimate, whatever their own.
const std::vector<std::string>& ParetoColumns();

// For RunSolverSweep; runs by material, map, then setting. The setting
// `default` is what options say (size, method, seconds, lobes); one that would
// be the same is left out beside it. `adam` is the reference: both unknowns by
// the schedule of Chen et al. 2020, however long it takes; the column rounds
// says how much of its ten rounds the solver took. results.md says how long the
// default takes to its misfit. A case's folder also receives
// pareto_SETTING.yaml and pareto_SETTING_.../; another size of image is a case
// of its own (CaseOfSize). Fails on a material, map, model or setting that is
// not there.
StatusOr<SolverSweep> ParetoSweep(const ParetoSweepOptions& options);

}  // namespace ibrdf
