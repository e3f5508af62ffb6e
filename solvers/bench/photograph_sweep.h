// The sweep `photographs`: joint estimates from files as cameras and renderers
// write them, beside those from the HDR image that they were made of.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/model_sweep.h"

namespace ibrdf {

struct PhotographSweepOptions : ModelSweepOptions {
  PhotographSweepOptions() { solver_seconds = 60.0; }

  std::vector<std::string> settings;  // by name; empty: all
};

// All names, comma-separated.
std::string PhotographSettingNames();

// Columns of its results.csv, in order; the first seven name the run.
const std::vector<std::string>& PhotographColumns();

// For RunSolverSweep; runs by material, map, then setting. A case's folder also
// receives photograph_SETTING.{exr,png,jpg}, ..._SETTING.yaml and results in
// photograph_SETTING_.../. Fails on a material, map, model or setting that is
// not there.
StatusOr<SolverSweep> PhotographSweep(const PhotographSweepOptions& options);

}  // namespace ibrdf
