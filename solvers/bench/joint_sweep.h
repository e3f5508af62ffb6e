// The sweep `joint`: reflectance and illumination from one image, over
// materials and maps, beside what baselines reach on the same images.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/model_sweep.h"

namespace ibrdf {

struct JointSweepOptions : ModelSweepOptions {
  // Priors of the light, by their names in problem files: a run each.
  std::vector<std::string> priors = {"process"};
};

// Columns of its results.csv, in order; the first seven name the run.
const std::vector<std::string>& JointColumns();

// For RunSolverSweep. A case's folder also receives
// joint_PRIOR.yaml, estimate_PRIOR_LOBES_METHOD[_MODEL]/ and cook_torrance.json
// (see joint_baselines.h). Fails on a material, map or model that is not there.
StatusOr<SolverSweep> JointSweep(const JointSweepOptions& options);

}  // namespace ibrdf
