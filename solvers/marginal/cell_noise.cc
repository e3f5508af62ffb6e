#include "solvers/marginal/cell_noise.h"

#include <algorithm>
#include <cmath>

#include "solvers/marginal/marginal_likelihood.h"

namespace ibrdf {
namespace {

// Of FindNoise, log radiance.
constexpr double kFirstSigma = 0.15;
// The mode moves with the strengths, and they with its residuals.
constexpr int kStrengthRounds = 2;
// Of FitStrength: deviations, a first look, and the end.
constexpr double kReach = 5.0;
constexpr double kScan = 0.25, kPrecision = 0.01;

}  // namespace

NoiseStrength FitStrength(const Eigen::Vector3d& residual,
                          const Eigen::Vector3d& texels, double sigma,
                          const LightProcess& process) {
  const auto prior = [&](double u) {
    const double y = (u - process.strength_mean) / process.strength_std;
    return 0.5 * y * y;
  };
  const auto cost = [&](double u) {
    const Eigen::Array3d D = sigma * sigma + std::exp(u) * texels.array();
    return prior(u) + 0.5 * (residual.array().square() / D + D.log()).sum();
  };
  // It may have two minima, one of noise and one of a lamp's edge.
  const double lowest = process.strength_mean - kReach * process.strength_std;
  const double highest = process.strength_mean + kReach * process.strength_std;
  double at = process.strength_mean, least = cost(at);
  const auto scan = [&](double from, double to, double step) {
    for (double u = from; u <= to; u += step) {
      const double here = cost(u);
      if (here < least) {
        least = here;
        at = u;
      }
    }
  };
  scan(lowest, highest, kScan);
  scan(std::max(at - kScan, lowest), std::min(at + kScan, highest), kPrecision);
  return {at, prior(at)};
}

Eigen::VectorXd MarginalLikelihood::NoiseVariance(
    const std::array<RowMatrix, 3>& matrices, double sigma,
    const LightMode& mode) const {
  const Eigen::Index t = num_texels(), n = num_sources(), P = num_points_;
  const Point point = At(matrices, mode.level, mode.l);
  Eigen::VectorXd noise(3 * P);
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd power =
        texel_variance_ * point.L.segment(c * n, t).cwiseAbs2();
    for (Eigen::Index p = 0; p < P; ++p) {
      const double* T = matrices[c].row(p).data();
      double sum = 0.0;
      const auto add = [&](int a, int b) {
        const double difference = T[a] - T[b];
        sum += difference * difference * (power[a] + power[b]);
      };
      for (int r = 0; r < map_height_; ++r) {
        const int row = r * map_width_;
        for (int x = 0; x < map_width_; ++x) {
          add(row + x, row + (x + 1) % map_width_);
          if (r + 1 < map_height_) add(row + x, row + map_width_ + x);
        }
      }
      const double E = point.E[c * P + p];
      noise[c * P + p] = sigma * sigma + 0.125 * sum / (E * E);
    }
  }
  return noise;
}

Eigen::VectorXd MarginalLikelihood::FindNoise(
    const std::array<RowMatrix, 3>& matrices, double sigma,
    const LightScales& scales, double tolerance, LightMode* mode) const {
  const Eigen::VectorXd first =
      Eigen::VectorXd::Constant(y_.size(), kFirstSigma * kFirstSigma);
  Evaluate(matrices, first, scales, tolerance, mode, nullptr);
  return NoiseVariance(matrices, sigma, *mode);
}

CellNoise MarginalLikelihood::FindCellNoise(
    const std::array<RowMatrix, 3>& matrices, double sigma,
    const LightScales& scales, double tolerance, LightMode* mode) const {
  CellNoise noise;
  noise.variance = FindNoise(matrices, sigma, scales, tolerance, mode);
  const Eigen::VectorXd texels =
      (noise.variance.array() - sigma * sigma).max(0.0);
  const Eigen::Index P = num_points_;
  const auto of_cell = [P](const Eigen::VectorXd& v, Eigen::Index p) {
    return Eigen::Vector3d(v[p], v[P + p], v[2 * P + p]);
  };
  for (int round = 0; round < kStrengthRounds; ++round) {
    Evaluate(matrices, noise.variance, scales, tolerance, mode, nullptr);
    const Point point = At(matrices, mode->level, mode->l);
    if (!point.residual.allFinite()) break;
    noise.cost = 0.0;
    for (Eigen::Index p = 0; p < P; ++p) {
      const NoiseStrength fit = FitStrength(
          of_cell(point.residual, p), of_cell(texels, p), sigma, process_);
      noise.cost += fit.cost;
      for (int c = 0; c < 3; ++c) {
        noise.variance[c * P + p] =
            sigma * sigma + std::exp(fit.log_strength) * texels[c * P + p];
      }
    }
  }
  return noise;
}

}  // namespace ibrdf
