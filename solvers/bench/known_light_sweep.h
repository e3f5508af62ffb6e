// The sweep `known-light` (Chen et al. 2020, Fig. 3): reflectance from one
// image under a known map, by models that have not seen the material.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/model_sweep.h"

namespace ibrdf {

struct KnownLightSweepOptions : ModelSweepOptions {};

// Columns of its results.csv, in order; the first six name the run.
const std::vector<std::string>& KnownLightColumns();

// For RunSolverSweep. A case's folder also receives known_light.yaml and
// known_light_LOBES_METHOD[_MODEL]/. Fails on a material, map or model that is
// not there.
StatusOr<SolverSweep> KnownLightSweep(const KnownLightSweepOptions& options);

}  // namespace ibrdf
