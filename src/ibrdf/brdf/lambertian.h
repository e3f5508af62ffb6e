// Analytic BRDF: the same radiance in every direction.
#pragma once
#include <Eigen/Core>

#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {

// f = albedo / pi, per channel.
struct Lambertian {
  Eigen::Array3d albedo{0.5, 0.5, 0.5};  // >= 0

  // 1/sr, at any angles.
  Eigen::Array3d Evaluate(double theta_h, double theta_d, double phi_d) const;

  // A copy of *this as a function.
  BrdfFunction Function() const;
};

}  // namespace ibrdf
