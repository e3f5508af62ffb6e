// The Laplacian likelihood of log radiance as a least-squares residual.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace ibrdf {

// Chen et al. 2020, Eq. 2: -log p = |log I - log L_o| / b + const per pixel and
// channel. With t = (log(L_o + epsilon) - log(I + epsilon)) / b and the
// smoothed magnitude rho(t) = sqrt(t^2 + delta^2) - delta, the residual r =
// sign(t) sqrt(2 rho(t)) has r^2 / 2 = rho(t): Ceres' sum of squares is the
// likelihood, one robust loss per pixel and channel however many share a block.
// r is smooth in t, with r ~ t / sqrt(delta) near 0.
struct RobustLogLikelihood {
  double scale = 0.02;    // b, natural log
  double epsilon = 1e-6;  // radiance
  double delta = 0.5;     // in units of b
  // Stray light that every pixel has beside what is rendered, radiance >= 0 by
  // channel.
  Eigen::Array3d ambient = Eigen::Array3d::Zero();
};

// The residual of t and dr/dt; both finite for any finite t.
inline double RobustResidual(double t, double delta, double* dr_dt) {
  // hypot: t * t may overflow.
  const double root = std::hypot(t, delta);
  // rho = t^2 / (root + delta): no cancellation at small t.
  const double s = std::sqrt(2.0 / (root + delta));
  if (dr_dt != nullptr) *dr_dt = 1.0 / (root * s);
  return t * s;
}

}  // namespace ibrdf
