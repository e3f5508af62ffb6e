// A BRDF that does not depend on phi_d, as a table: the best that any model of
// (theta_h, theta_d) can do (Romeiro et al. 2008).
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Raw values at the bin centres of a MERL table: [channel][theta_h][theta_d].
struct BivariateTable {
  std::vector<double> raw;  // [3 * 90 * 90], >= 0

  static constexpr int Cell(int theta_h, int theta_d) {
    return theta_h * kMerlThetaD + theta_d;
  }
  double Raw(int channel, int theta_h, int theta_d) const {
    return raw[static_cast<size_t>(channel) * kMerlThetaH * kMerlThetaD +
               Cell(theta_h, theta_d)];
  }

  // 1/sr at angles in radians, linear between bin centres (theta_h on its
  // square-root axis), clamped beyond the first and last centre. Reciprocal.
  Eigen::Array3d Evaluate(double theta_h, double theta_d, double phi_d) const;

  // A copy of *this as a function.
  BrdfFunction Function() const;
};

enum class BivariateMean {
  kGeometric,   // of max(raw, 0) + 1e-6: least log-RMSE among such tables
  kArithmetic,  // of max(raw, 0)
};

// Mean over the bins of each (theta_h, theta_d) whose red value is > 0. Where
// there are none, the value at the nearest smaller theta_h that has some, else
// at the nearest larger, else 0. Fails on a table without a positive red value
// and on non-finite values; the message starts with "table".
StatusOr<BivariateTable> FitBivariate(const MerlTable& table,
                                      BivariateMean mean);

}  // namespace ibrdf
