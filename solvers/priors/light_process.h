// What natural light looks like before an image is seen: log radiance as a
// Gaussian process on the sphere.
#pragma once
#include <Eigen/Core>
#include <array>

#include "ibrdf/solvers/optim/dense_algebra.h"

namespace ibrdf {

// What differs from light to light, and is estimated with it: how much it
// varies, and how rough it is by elevation. Skies are smooth; horizons,
// directional lights and windows are not.
struct LightHyperparameters {
  // Zenith angles, degrees, at which log_roughness is given; linear between
  // them, constant beyond.
  static constexpr int kBands = 4;
  static constexpr std::array<double, kBands> kZenith = {40, 75, 103, 140};
  // Normal prior.
  static constexpr double kAmplitudeStd = 0.7;
  static constexpr std::array<double, kBands> kMean = {-1.2, 0.0, -0.2, -0.8};
  static constexpr std::array<double, kBands> kStd = {1.2, 0.5, 0.5, 0.6};

  double log_amplitude = 0.0;
  std::array<double, kBands> log_roughness = kMean;

  // Where they are not estimated: the variances of all maps together, which
  // rough places make.
  static LightHyperparameters Average() { return {0.0, {0.0, 0.0, 0.0, 0.0}}; }

  // A deviation above the mean in all: few bright directional lights in the
  // dark.
  static LightHyperparameters Harsh() {
    LightHyperparameters hyperparameters{kAmplitudeStd, kMean};
    for (int b = 0; b < kBands; ++b)
      hyperparameters.log_roughness[b] += kStd[b];
    return hyperparameters;
  }

  // As standard normal variables, the amplitude first.
  static constexpr int kCount = 1 + kBands;
  std::array<double, kCount> Whitened() const;
  static LightHyperparameters FromWhitened(const double* y);
  static std::array<double, kCount> Stds();
};

// log L_c(w) = m + l_c(w), with
//   cov(l_c(w), l_d(w')) = amplitude M_cd C(w, w') + B_cd,
//   C = smooth_share (1 + x) exp(-x)
//       + rough_share S(w) S(w') exp(-angle(w, w') / rough_degrees)
//       + horizon_share h(w) h(w') / amplitude,
//   x = |w - w'| / smooth_degrees, S the roughness,
//   h = 1/2 above the horizon, -1/2 below: the ground is darker or brighter
//   than the sky by a step, however little the light varies otherwise,
//   M = luminance_variance 11^T + chroma_variance (I - 11^T / 3),
//   B = level_variance 11^T + level_chroma_variance (I - 11^T / 3).
// The exponential's paths are rough. Defaults: semivariograms of maps at 32x16,
// and variances inside texels of each (experiments/light_statistics).
struct LightProcess {
  double smooth_share = 0.75, smooth_degrees = 40.0;
  double rough_share = 0.375, rough_degrees = 20.0;
  double horizon_share = 0.6;
  double luminance_variance = 1.6;
  double chroma_variance = 0.12;
  double level_variance = 4.0;
  double level_chroma_variance = 0.12;
  // Variances of a directional light's log radiance beside those above
  // (directional_lights.h). The amplitude does not scale them.
  double directional_light_variance = 6.25;
  double directional_light_chroma_variance = 0.25;

  // Variance of one channel's log radiance inside a square of that side, at
  // amplitude 1 and roughness 1.
  double VarianceWithin(double degrees) const;

  Eigen::Matrix3d Local() const;  // M
  Eigen::Matrix3d Level() const;  // B
  // The covariance of a directional light, beside B.
  Eigen::Matrix3d DirectionalLight() const;

  // The first two parts of C between unit directions, without shares and
  // roughness.
  double Smooth(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  double Rough(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
};

// Rows: grey, then two axes of chroma; orthonormal. They diagonalise Local(),
// Level() and DirectionalLight().
Eigen::Matrix3d ColourAxes();

// Weights of log_roughness in the rows of a map, [bands][rows].
RowMatrix RoughnessWeights(int map_height);
// S [rows].
Eigen::VectorXd Roughness(int map_height,
                          const LightHyperparameters& hyperparameters);
// h [rows]; 0 in a row that the horizon halves.
Eigen::VectorXd HorizonStep(int map_height);
// What texels [H W] have from their rows [H].
Eigen::VectorXd ByTexel(const Eigen::VectorXd& by_row, int map_width);

// C between the texels of a map, [H W][H W].
RowMatrix LightCorrelation(int map_height, int map_width,
                           const LightProcess& process,
                           const LightHyperparameters& hyperparameters);

}  // namespace ibrdf
