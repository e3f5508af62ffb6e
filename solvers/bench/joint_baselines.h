// What the sweep `joint` holds its estimates against.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/baselines/cook_torrance_fit.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/sweep_cases.h"

namespace ibrdf {

struct CookTorranceScore {
  double misfit = 0.0;
  double brdf_log_rmse = 0.0, brdf_log_rmse_aligned = 0.0;
  double brdf_log_rmse_aligned_below80 = 0.0;
};

// Lambertian plus Cook-Torrance fitted to the case's input given the true map.
// It does not depend on the estimate: CaseFolder/cook_torrance.json holds it
// with the input's settings and the options, and is made anew where these, or
// the file, are others. The number of threads does not matter.
StatusOr<CookTorranceScore> ScoreCookTorrance(
    const SweepOptions& options, const SweepCase& c,
    const CookTorranceFitOptions& fit = {});

// Sets the columns cook_torrance_... and constant_map_... of the row.
Status SetJointBaselines(const SweepOptions& options, const SweepCase& c,
                         NamedRow* row);

}  // namespace ibrdf
