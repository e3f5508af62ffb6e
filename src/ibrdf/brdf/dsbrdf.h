// Analytic BRDF: sums of hemispherical exponential-power lobes (Nishino 2009,
// "Directional statistics BRDF model").
#pragma once
#include <Eigen/Core>
#include <array>

#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {

// The non-zero values of a clamped uniform cubic B-spline basis on
// [0, pi/2]: functions `first` to `first` + 3. They are >= 0 and sum to 1, so
// a curve stays within its coefficients.
struct SplineBasis {
  // num_coefficients >= 4; theta in radians, clamped to the interval.
  SplineBasis(int num_coefficients, double theta);

  int first;
  std::array<double, 4> weight;
};

// Sizes of the model; parameters of a channel, all of them unbounded:
//   [lobe][log kappa, log gamma][coefficient], then log unit.
struct DsbrdfShape {
  int lobes = 3;         // >= 1
  int coefficients = 6;  // of each curve over theta_d, >= 4

  int num_parameters() const { return lobes * 2 * coefficients + 1; }
  int LogKappa(int lobe) const { return 2 * lobe * coefficients; }
  int LogGamma(int lobe) const { return (2 * lobe + 1) * coefficients; }
  int LogUnit() const { return lobes * 2 * coefficients; }
};

// f = unit sum_r (exp(kappa_r cos^gamma_r(theta_h)) - 1), log kappa and log
// gamma cubic splines over theta_d, per channel. The published model has unit =
// 1 in the units of its data, where the shape of a lobe depends on its height;
// here the unit (1/sr) is fitted too. The same for all phi_d, so reciprocal.
struct Dsbrdf {
  DsbrdfShape shape;
  std::array<Eigen::VectorXd, 3> parameters;  // of each channel

  // 1/sr at angles in radians. Finite; 0 without parameters.
  Eigen::Array3d Evaluate(double theta_h, double theta_d, double phi_d) const;

  // A copy of *this as a function.
  BrdfFunction Function() const;
};

// What f takes from the angles alone, to be kept over the iterations of a fit.
struct DsbrdfGeometry {
  DsbrdfGeometry(const DsbrdfShape& shape, double theta_h, double theta_d);

  double log_cos_h;
  SplineBasis basis;
};

// f of a channel, 1/sr, from its shape.num_parameters() parameters, and where
// `gradient` is not null df/dparameters there.
double EvaluateDsbrdf(const DsbrdfShape& shape, const double* parameters,
                      const DsbrdfGeometry& geometry, double* gradient);

}  // namespace ibrdf
