// The sweep `known-brdf` (Chen et al. 2020, Fig. 4 and supplement, Table 2):
// illumination from one image of a known material, with the priors of the light
// and without.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/solver_sweep.h"

namespace ibrdf {

struct KnownBrdfSweepOptions : SolverSweepOptions {
  std::vector<std::string> priors = {"process", "none"};
};

// Columns of its results.csv, in order; the first five name the run.
const std::vector<std::string>& KnownBrdfColumns();

// For RunSolverSweep; runs by material, map, then prior. A case's folder also
// receives known_brdf_PRIOR.yaml and known_brdf_PRIOR_METHOD/. Estimated maps
// are compared as spheres too (sphere_metrics.h), with the true map at the
// estimate's size. Fails on a material or map that is not there.
StatusOr<SolverSweep> KnownBrdfSweep(const KnownBrdfSweepOptions& options);

}  // namespace ibrdf
