#include "ibrdf/brdf/merl_columns.h"

#include <algorithm>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

FlowColumns MerlColumns() {
  FlowColumns columns(kMerlThetaD * kMerlPhiD, kMerlThetaH);
  for (int j = 0; j < kMerlThetaD; ++j) {
    for (int k = 0; k < kMerlPhiD; ++k) {
      const int column = j * kMerlPhiD + k;
      for (int i = 0; i < kMerlThetaH; ++i) {
        const Eigen::Vector3d x =
            ToUnitCube(MerlThetaH(i), MerlThetaD(j), MerlPhiD(k));
        if (i == 0) columns.SetColumn(column, x[1], x[2]);
        columns.x_h[static_cast<size_t>(i) * columns.columns + column] =
            std::min(static_cast<float>(x[0]), 1.0f);
      }
    }
  }
  return columns;
}

Eigen::Vector3d WithinMerlBins(const Eigen::Vector3d& x) {
  const double theta_d =
      std::min(x[1] * (kPi / 2), MerlThetaD(kMerlThetaD - 1));
  const Eigen::Vector3d first = ToUnitCube(MerlThetaH(0), theta_d, x[2] * kPi);
  return {std::max(x[0], first[0]), first[1], x[2]};
}

}  // namespace ibrdf
