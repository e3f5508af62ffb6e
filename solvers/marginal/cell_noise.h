// How strong the light inside the map's texels is where a cell sees it.
#pragma once
#include <Eigen/Core>

#include "solvers/marginal/light_process.h"

namespace ibrdf {

// Of the cells' log radiance, [3 * cells], and the cost of their strengths
// under the prior, nats.
struct CellNoise {
  Eigen::VectorXd variance;
  double cost = 0.0;
};

struct NoiseStrength {
  double log_strength = 0.0;
  double cost = 0.0;  // 1/2 ((u - mean) / std)^2
};

// The log strength u of one cell where
//   1/2 ((u - mean) / std)^2 + 1/2 sum_c (r_c^2 / D_c + log D_c),
//   D_c = sigma^2 + e^u texels_c,
// is least, mean and std those of LightProcess, within five deviations and to
// 0.01. residual, texels: of the three channels; texels >= 0.
NoiseStrength FitStrength(const Eigen::Vector3d& residual,
                          const Eigen::Vector3d& texels, double sigma,
                          const LightProcess& process);

}  // namespace ibrdf
