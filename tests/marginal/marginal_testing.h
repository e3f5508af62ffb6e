// A sphere under a smooth map, at a resolution for tests of the marginal
// likelihood of lobes.
#pragma once
#include <gtest/gtest.h>

#include <vector>

#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "ibrdf/solvers/marginal/marginal_reflectance.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace testing {

// One in front, one behind the sphere.
inline const std::vector<Eigen::Vector3d> kDirectionalLights = {
    Eigen::Vector3d(0.6, 0.5, 0.6).normalized(),
    Eigen::Vector3d(-0.8, 0.1, -0.5).normalized()};

class MarginalTest : public ::testing::Test {
 protected:
  MarginalTest() {
    resolution_.bins = {6, 3, 0.2};
    resolution_.map_width = 16;
    resolution_.map_height = 8;
    resolution_.grid = TinyTransportOptions().grid;
  }

  const NeuralBrdfModel model_ = SmoothTinyModel(4);
  const std::vector<ShadingPoint> points_ = SpherePoints(12);
  MarginalResolution resolution_;
  const std::vector<double> truth_ = TinyLobes();
  const std::vector<double> radiance_ =
      RenderTinyLobes(model_, points_, SmoothMap(8, 16));
};

// Gradient at x against differences, of these parameters and all
// hyperparameters.
inline void ExpectGradient(const MarginalReflectance& reflectance,
                           const std::vector<double>& x,
                           const std::vector<int>& parameters) {
  const int n = reflectance.num_parameters();
  ASSERT_EQ(n, static_cast<int>(x.size()));
  const Eigen::VectorXd noise =
      Eigen::VectorXd::Constant(3 * reflectance.bins().num_bins(), 0.0025);
  const auto evaluate = [&](const std::vector<double>& at,
                            const LightHyperparameters& hyperparameters,
                            std::vector<double>* gradient) {
    LightMode mode;
    mode.l = mode.representers =
        Eigen::VectorXd::Zero(3 * reflectance.likelihood().num_sources());
    const MarginalValue value = reflectance.Evaluate(
        at.data(), {noise, {}}, hyperparameters, 1e-12, &mode, gradient);
    EXPECT_TRUE(value.ok);
    return std::vector<double>{value.cost};
  };
  std::vector<double> gradient;
  evaluate(x, {0.2}, &gradient);
  ASSERT_EQ(n + 5, static_cast<int>(gradient.size()));
  const double scale = Norm(gradient);
  std::vector<int> all = parameters;
  for (int k = 0; k < 5; ++k) all.push_back(n + k);
  for (const int i : all) {
    const double numeric = Differentiate(
        [&](double t) {
          std::vector<double> at = x;
          if (i < n) at[i] += t;
          LightHyperparameters hyperparameters = {0.2};
          if (i == n) hyperparameters.log_amplitude += t;
          if (i > n) hyperparameters.log_roughness[i - n - 1] += t;
          return evaluate(at, hyperparameters, nullptr);
        },
        0.05)[0];
    // The lobes' tables are float.
    EXPECT_NEAR(numeric, gradient[i], 5e-3 * scale) << i;
  }
}

}  // namespace testing
}  // namespace ibrdf
