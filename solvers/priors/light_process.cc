#include "ibrdf/solvers/priors/light_process.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

Eigen::Matrix3d GreyAndChroma(double grey, double chroma) {
  return grey * Eigen::Matrix3d::Ones() +
         chroma * (Eigen::Matrix3d::Identity() -
                   Eigen::Matrix3d::Constant(1.0 / 3.0));
}

}  // namespace

std::array<double, LightHyperparameters::kCount>
LightHyperparameters::Whitened() const {
  std::array<double, kCount> y;
  y[0] = log_amplitude / kAmplitudeStd;
  for (int b = 0; b < kBands; ++b) {
    y[1 + b] = (log_roughness[b] - kMean[b]) / kStd[b];
  }
  return y;
}

LightHyperparameters LightHyperparameters::FromWhitened(const double* y) {
  LightHyperparameters hyperparameters;
  hyperparameters.log_amplitude = kAmplitudeStd * y[0];
  for (int b = 0; b < kBands; ++b) {
    hyperparameters.log_roughness[b] = kMean[b] + kStd[b] * y[1 + b];
  }
  return hyperparameters;
}

std::array<double, LightHyperparameters::kCount> LightHyperparameters::Stds() {
  std::array<double, kCount> stds;
  stds[0] = kAmplitudeStd;
  std::copy(kStd.begin(), kStd.end(), stds.begin() + 1);
  return stds;
}

double LightProcess::VarianceWithin(double degrees) const {
  // The mean distance of two points in a unit square is 0.52. What the smooth
  // part varies there is of second order.
  return rough_share * (luminance_variance + chroma_variance * 2.0 / 3.0) *
         (1.0 - std::exp(-0.52 * degrees / rough_degrees));
}

Eigen::Matrix3d LightProcess::Local() const {
  return GreyAndChroma(luminance_variance, chroma_variance);
}

Eigen::Matrix3d LightProcess::Level() const {
  return GreyAndChroma(level_variance, level_chroma_variance);
}

Eigen::Matrix3d LightProcess::DirectionalLight() const {
  return GreyAndChroma(directional_light_variance,
                       directional_light_chroma_variance);
}

Eigen::Matrix3d ColourAxes() {
  Eigen::Matrix3d axes;
  axes << 1 / std::sqrt(3.0), 1 / std::sqrt(3.0), 1 / std::sqrt(3.0),  //
      1 / std::sqrt(2.0), -1 / std::sqrt(2.0), 0.0,                    //
      1 / std::sqrt(6.0), 1 / std::sqrt(6.0), -2 / std::sqrt(6.0);
  return axes;
}

double LightProcess::Smooth(const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b) const {
  const double x = (a - b).norm() / (kDegree * smooth_degrees);
  return (1.0 + x) * std::exp(-x);
}

double LightProcess::Rough(const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b) const {
  return std::exp(-std::acos(std::clamp(a.dot(b), -1.0, 1.0)) /
                  (kDegree * rough_degrees));
}

RowMatrix RoughnessWeights(int map_height) {
  constexpr int kLast = LightHyperparameters::kBands - 1;
  const auto& zenith = LightHyperparameters::kZenith;
  RowMatrix weights = RowMatrix::Zero(LightHyperparameters::kBands, map_height);
  for (int r = 0; r < map_height; ++r) {
    const double at =
        std::clamp(180.0 * (r + 0.5) / map_height, zenith[0], zenith[kLast]);
    int b = 0;
    while (b + 1 < kLast && at >= zenith[b + 1]) ++b;
    const double x = (at - zenith[b]) / (zenith[b + 1] - zenith[b]);
    weights(b, r) = 1.0 - x;
    weights(b + 1, r) = x;
  }
  return weights;
}

Eigen::VectorXd Roughness(int map_height,
                          const LightHyperparameters& hyperparameters) {
  const Eigen::Map<const Eigen::RowVectorXd> log_roughness(
      hyperparameters.log_roughness.data(), LightHyperparameters::kBands);
  return (log_roughness * RoughnessWeights(map_height))
      .transpose()
      .array()
      .exp();
}

Eigen::VectorXd HorizonStep(int map_height) {
  Eigen::VectorXd step(map_height);
  for (int r = 0; r < map_height; ++r) {
    step[r] = 0.5 * ((2 * r + 1 < map_height) - (2 * r + 1 > map_height));
  }
  return step;
}

Eigen::VectorXd ByTexel(const Eigen::VectorXd& by_row, int map_width) {
  return by_row.transpose().replicate(map_width, 1).reshaped();
}

RowMatrix LightCorrelation(int map_height, int map_width,
                           const LightProcess& process,
                           const LightHyperparameters& hyperparameters) {
  const Eigen::VectorXd roughness = Roughness(map_height, hyperparameters);
  const Eigen::VectorXd step = HorizonStep(map_height);
  const double horizon =
      process.horizon_share * std::exp(-hyperparameters.log_amplitude);
  std::vector<Eigen::Vector3d> directions;
  for (int r = 0; r < map_height; ++r) {
    for (int c = 0; c < map_width; ++c) {
      directions.push_back(
          MapDirection(r + 0.5, c + 0.5, map_height, map_width));
    }
  }
  const auto n = static_cast<Eigen::Index>(directions.size());
  RowMatrix correlation(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      // Rounding would leave a texel a little apart from itself.
      const double smooth =
          i == j ? 1.0 : process.Smooth(directions[i], directions[j]);
      const double rough =
          i == j ? 1.0 : process.Rough(directions[i], directions[j]);
      correlation(i, j) = correlation(j, i) =
          process.smooth_share * smooth +
          process.rough_share * roughness[i / map_width] *
              roughness[j / map_width] * rough +
          horizon * step[i / map_width] * step[j / map_width];
    }
  }
  return correlation;
}

}  // namespace ibrdf
