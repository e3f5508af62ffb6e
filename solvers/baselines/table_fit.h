// Analytic BRDFs fitted to MERL tables: what a learnt BRDF is compared with.
#pragma once
#include <cstdint>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/disney.h"
#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/solvers/baselines/table_cost.h"

namespace ibrdf {

struct TableFitOptions {
  uint64_t seed = 1;          // of the subset of bins that a fit sees
  TableSolverOptions solver;  // of the best start
};

// Each returns the model with the least sum of squares of
// log(f + 1e-6) - log(max(raw, 0) + 1e-6), raw units, that several starts
// reach: the log-RMSE of CompareBrdfs, over about 5000 bins in proportion. One
// thread. They fail on a table without a positive red value and on non-finite
// values; the message starts with "table".

// Exact, over all bins: the geometric mean of each channel.
StatusOr<Lambertian> FitLambertian(const MerlTable& table);

// Each channel on its own.
StatusOr<CookTorrance> FitCookTorranceToTable(const MerlTable& table,
                                              const TableFitOptions& options);

// The channels share roughness and f0.
StatusOr<CookTorrance> FitColouredCookTorranceToTable(
    const MerlTable& table, const TableFitOptions& options);

// The channels share all but the base colour.
StatusOr<Disney> FitDisney(const MerlTable& table,
                           const TableFitOptions& options);

}  // namespace ibrdf
