// The directional statistics BRDF fitted to MERL tables.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/brdf/dsbrdf.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/solvers/baselines/table_cost.h"

namespace ibrdf {

struct DsbrdfFitOptions {
  DsbrdfShape shape;
  TableSolverOptions coarse{40, 1e-4};   // of each start, every sixth sample
  TableSolverOptions solver{150, 1e-6};  // of the best start, all samples
};

// Each channel on its own, over all bins: the model does not depend on phi_d,
// so the mean over it is all that counts. Cost and failures as in table_fit.h.
// One thread, no random number.
StatusOr<Dsbrdf> FitDsbrdf(const MerlTable& table,
                           const DsbrdfFitOptions& options);

}  // namespace ibrdf
