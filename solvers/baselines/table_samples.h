// What a fit sees of a MERL table: fewer bins, with the same minimum.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Inside the logarithms, raw units, as in CompareBrdfs.
inline constexpr double kTableLogFloor = 1e-6;

struct TableSample {
  double theta_h, theta_d, phi_d;  // of a bin's centre, radians
  // Mean of log(max(raw, 0) + kTableLogFloor), natural, over the bins that a
  // model cannot tell apart.
  Eigen::Array3d log_raw;
  double weight;  // share of the valid bins it stands for; they sum to 1
};

// Valid bins are those whose red value is > 0, as in CompareBrdfs. Both
// functions fail on a table without any and on non-finite values there; the
// message starts with "table".

// One random bin of each block of 2 x 4 x 15 (theta_h, theta_d, phi_d) with a
// valid one, for models with f(phi_d) = f(pi - phi_d), as isotropy and
// reciprocity imply: phi_d is folded to [0, pi/2], about 5000 samples. The
// same seed gives the same bins.
StatusOr<std::vector<TableSample>> SampleBins(const MerlTable& table,
                                              uint64_t seed);

// The mean over phi_d of each (theta_h, theta_d), for models that do not depend
// on it: their squared error over the samples is that over all bins but for a
// constant. At most 8100 samples, theta_h outermost.
StatusOr<std::vector<TableSample>> AverageOverPhi(const MerlTable& table);

// A model in the bins of `like`: those above the horizon and those where the
// red value of `like` is > 0; -1 in the others. depends_on_phi_d = false calls
// brdf once for each (theta_h, theta_d), with phi_d = pi/2.
MerlTable SampleBrdf(const BrdfFunction& brdf, bool depends_on_phi_d,
                     const MerlTable& like);

}  // namespace ibrdf
