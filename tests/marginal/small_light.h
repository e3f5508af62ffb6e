// A light of few texels, and points that see it through round lobes.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/marginal/marginal_likelihood.h"

namespace ibrdf {

inline constexpr int kHeight = 4, kWidth = 8, kTexels = kHeight * kWidth;
inline constexpr int kPoints = 6;

// Lobes of a width in radians about random directions, as matrices of three
// like channels; directional lights in random directions.
inline std::array<RowMatrix, 3> Lobes(double width, int points = kPoints,
                                      int directional_lights = 0) {
  std::mt19937_64 rng(7);
  std::normal_distribution<double> g;
  const auto direction = [&] {
    return Eigen::Vector3d(g(rng), g(rng), g(rng)).normalized();
  };
  RowMatrix T(points, kTexels + directional_lights);
  for (int p = 0; p < points; ++p) {
    const Eigen::Vector3d axis = direction();
    for (int r = 0; r < kHeight; ++r) {
      for (int c = 0; c < kWidth; ++c) {
        const double x =
            axis.dot(MapDirection(r + 0.5, c + 0.5, kHeight, kWidth));
        T(p, r * kWidth + c) = TexelSolidAngle(r, kHeight, kWidth) *
                               (std::exp((x - 1) / (width * width)) + 1e-4);
      }
    }
    for (int k = 0; k < directional_lights; ++k) {
      const double x = axis.dot(direction());
      T(p, kTexels + k) = 0.3 * (std::exp((x - 1) / (width * width)) + 1e-4);
    }
  }
  return {T, 0.7 * T, 1.3 * T};
}

inline Eigen::VectorXd DrawLight(const LightProcess& process, double amplitude,
                                 uint64_t seed, int directional_lights = 0) {
  LightHyperparameters hyperparameters;
  hyperparameters.log_amplitude = std::log(amplitude);
  const RowMatrix C =
      LightCorrelation(kHeight, kWidth, process, hyperparameters);
  const int n = kTexels + directional_lights;
  Eigen::MatrixXd K(3 * n, 3 * n);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      Eigen::MatrixXd local = Eigen::MatrixXd::Zero(n, n);
      local.topLeftCorner(kTexels, kTexels) =
          amplitude * process.Local()(c, d) * C;
      local.diagonal()
          .tail(directional_lights)
          .setConstant(process.DirectionalLight()(c, d));
      K.block(c * n, d * n, n, n) = local.array() + process.Level()(c, d);
    }
  }
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> g;
  Eigen::VectorXd white(3 * n);
  for (double& w : white) w = g(rng);
  return K.llt().matrixL() * white;
}

inline std::vector<double> LogRadiance(const std::array<RowMatrix, 3>& T,
                                       const Eigen::VectorXd& l) {
  std::vector<double> y;
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd L_o =
        T[c] * l.segment(c * T[c].cols(), T[c].cols()).array().exp().matrix();
    for (const double e : L_o) y.push_back(std::log(e));
  }
  return y;
}

inline DataErrors Noise(double sigma, int points = kPoints) {
  return {Eigen::VectorXd::Constant(3 * points, sigma * sigma), {}};
}

// A level that the process itself holds, so that nothing is improper.
inline LightProcess Proper() {
  LightProcess process;
  process.level_variance = 0.5;
  return process;
}

// Light of which a drawn sample says nearly all.
inline LightProcess LittleVariance() {
  LightProcess process = Proper();
  process.level_variance = 0.01;
  process.level_chroma_variance = 0.002;
  process.horizon_share = 0.02;
  return process;
}

// Constant light of radiance 1, unpainted: where a search may begin.
inline LightMode ZeroMode(const MarginalLikelihood& likelihood) {
  LightMode mode;
  mode.l = mode.representers = Eigen::VectorXd::Zero(likelihood.num_latents());
  return mode;
}

// No band is like another.
inline LightHyperparameters Rough() { return {0.3, {-1.5, 0.4, -0.3, 0.8}}; }

// Scale `k` moved, the amplitude first.
inline LightHyperparameters Moved(LightHyperparameters hyperparameters, int k,
                                  double step) {
  (k == 0 ? hyperparameters.log_amplitude
          : hyperparameters.log_roughness[k - 1]) += step;
  return hyperparameters;
}

inline MarginalLikelihood Likelihood(LogRadianceData data,
                                     const LightProcess& process,
                                     int directional_lights = 0,
                                     const Eigen::MatrixXd& paint = {}) {
  return MarginalLikelihood(std::move(data), process, kHeight, kWidth,
                            directional_lights, 1, paint);
}

// Paint of the points, as MarginalLikelihood takes it.
struct Paint {
  Eigen::MatrixXd covariance;   // [3 * points]^2
  Eigen::VectorXd matte_share;  // [3 * points]
  Eigen::VectorXd mean = {};    // [3 * points] or empty
};

// Nats, of the mode: its last steps shrink slowly, and the log determinant
// feels what is left to first order.
inline constexpr double kTight = 1e-18;

// At deviations `sigma` of all data.
inline double Cost(const LogRadianceData& data,
                   const std::array<RowMatrix, 3>& T,
                   const LightHyperparameters& hyperparameters,
                   MarginalGradient* gradient, int directional_lights = 0,
                   double sigma = 0.1, const Paint& paint = {}) {
  const MarginalLikelihood likelihood =
      Likelihood(data, Proper(), directional_lights, paint.covariance);
  LightMode mode = ZeroMode(likelihood);
  DataErrors errors = Noise(sigma, static_cast<int>(data.value.size() / 3));
  errors.matte_share = paint.matte_share;
  errors.mean_paint = paint.mean;
  const MarginalValue value =
      likelihood.Evaluate(T, errors, hyperparameters, kTight, &mode, gradient);
  EXPECT_TRUE(value.ok);
  return value.cost;
}

// That the gradient is what differences of the cost are, by hyperparameters and
// by directions of the matrices, of data that `data_of` makes of log radiance.
inline void ExpectGradientMatches(
    const std::function<LogRadianceData(const std::vector<double>&)>& data_of,
    const Paint& paint = {}) {
  for (const auto& [width, directional_lights] :
       {std::pair(0.3, 0), std::pair(1.0, 0), std::pair(0.3, 2)}) {
    const std::array<RowMatrix, 3> T =
        Lobes(width, kPoints, directional_lights);
    std::vector<double> y =
        LogRadiance(T, DrawLight(Proper(), 1.0, 2, directional_lights));
    // Not what the model can render: the mode keeps residuals.
    for (size_t i = 0; i < y.size(); ++i) y[i] += 0.2 * std::sin(5.0 * i);
    const LogRadianceData data = data_of(y);
    const auto cost = [&, lights = directional_lights](
                          const std::array<RowMatrix, 3>& matrices,
                          const LightHyperparameters& at,
                          MarginalGradient* gradient) {
      return Cost(data, matrices, at, gradient, lights, 0.1, paint);
    };
    MarginalGradient gradient;
    const LightHyperparameters hyperparameters = Rough();
    cost(T, hyperparameters, &gradient);
    const double h = 1e-3;
    for (int k = 0; k < LightHyperparameters::kCount; ++k) {
      const double numeric = (cost(T, Moved(hyperparameters, k, h), nullptr) -
                              cost(T, Moved(hyperparameters, k, -h), nullptr)) /
                             (2 * h);
      EXPECT_NEAR(numeric, gradient.hyperparameters[k],
                  1e-3 * std::abs(gradient.hyperparameters[k]) + 1e-3)
          << k;
    }
    std::mt19937_64 rng(1);
    std::normal_distribution<double> g;
    for (int trial = 0; trial < 4; ++trial) {
      std::array<RowMatrix, 3> up = T, down = T;
      double expected = 0.0;
      for (int c = 0; c < 3; ++c) {
        const RowMatrix direction =
            T[c].unaryExpr([&](double t) { return t * g(rng); });
        up[c] += h * direction;
        down[c] -= h * direction;
        expected += gradient.matrices[c].cwiseProduct(direction).sum();
      }
      EXPECT_NEAR((cost(up, hyperparameters, nullptr) -
                   cost(down, hyperparameters, nullptr)) /
                      (2 * h),
                  expected, 2e-3 * std::abs(expected) + 2e-3)
          << width;
    }
  }
}

}  // namespace ibrdf
