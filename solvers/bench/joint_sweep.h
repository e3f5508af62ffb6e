// The sweep `joint`: reflectance and illumination from one image, over
// materials and maps, beside what baselines reach on the same images.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "solvers/bench/held_out_models.h"
#include "solvers/bench/solver_sweep.h"

namespace ibrdf {

struct JointSweepOptions : SolverSweepOptions, ModelOptions {
  int lobes = 2;
};

// Columns of its results.csv, in order; the first six name the run.
const std::vector<std::string>& JointColumns();

// What options select, by material, then map. Fails on a material, map or model
// that is not there.
StatusOr<std::vector<SolverRun>> ListJointRuns(
    const JointSweepOptions& options);

// See RunSolverSweep. A case's folder also receives joint.yaml and
// estimate_LOBES_METHOD[_MODEL]/.
Status RunJointSweep(const JointSweepOptions& options);

}  // namespace ibrdf
