// What natural light looks like before an image is seen: log radiance as a
// Gaussian process on the sphere.
#pragma once
#include <Eigen/Core>

#include "solvers/marginal/dense_algebra.h"

namespace ibrdf {

// log L_c(w) = m + l_c(w), with
//   cov(l_c(w), l_d(w')) = amplitude M_cd exp(-angle(w, w') / correlation)
//                          + B_cd,
//   M = luminance_variance 11^T + chroma_variance (I - 11^T / 3),
//   B = level_variance 11^T + level_chroma_variance (I - 11^T / 3).
// The exponential's paths are rough, as light with its horizons, lamps and
// windows is. Defaults: semivariograms of maps at 32x16
// (experiments/light_statistics).
struct LightProcess {
  double luminance_variance = 1.6;
  double chroma_variance = 0.12;
  double correlation_degrees = 52.0;
  double level_variance = 4.0;
  double level_chroma_variance = 0.12;

  // Variance of one channel's log radiance inside a square of that side, at
  // amplitude 1.
  double VarianceWithin(double degrees) const;

  Eigen::Matrix3d Local() const;  // M
  Eigen::Matrix3d Level() const;  // B
};

// Rows: grey, then two axes of chroma; orthonormal. They diagonalise Local()
// and Level().
Eigen::Matrix3d ColourAxes();

// exp(-angle / correlation) between two unit directions.
double LightCorrelation(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        double correlation_degrees);

// The same between the texels of a map, [H W][H W].
RowMatrix LightCorrelation(int map_height, int map_width,
                           double correlation_degrees);

}  // namespace ibrdf
