// Spheres in the tables of sweeps (Chen et al. 2020, supplement, Table 1).
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/solver_sweep.h"
#include "ibrdf/solvers/bench/sphere_metrics.h"

namespace ibrdf {

// Sets the columns NAME_log_rmse, NAME_rmse and NAME_dssim.
void SetSphere(const std::string& name, const SphereMetrics& metrics,
               NamedRow* row);

// Sets the columns of "mirror": the estimated map against the true one.
// `folder` of the case.
Status SetMirror(const SweepOptions& options, const SolverRun& run,
                 const std::string& folder, NamedRow* row);

// Sets the columns of "relit": the estimated reflectance against the true one
// under the map that follows the input's in the folder of all maps, the first
// after the last; they stay empty where there is no other.
Status SetRelit(const SweepOptions& options, const SolverRun& run,
                const std::string& folder, NamedRow* row);

}  // namespace ibrdf
