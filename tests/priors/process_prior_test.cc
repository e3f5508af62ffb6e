#include "ibrdf/solvers/priors/process_prior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/illumination/process_illumination.h"
#include "ibrdf/solvers/priors/directional_lights.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {

LogMap RandomLogMap(int height, int width, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> g;
  std::vector<float> map(static_cast<size_t>(3) * height * width);
  for (float& v : map) v = g(rng);
  return {{width, height}, map};
}

TEST(ProcessPrior, GradientAndProductMatchDifferences) {
  // Blocks of one texel, of four, and of different sizes.
  for (const int width : {16, 64, 70}) {
    const int height = width / 2;
    ProcessPrior prior(height, width, LightProcess(), {0.4}, 0.3,
                       {MapDirection(0.4 * height, 5.3, height, width)});
    const LogMap map = RandomLogMap(height, width, 1);
    const LogMap v = RandomLogMap(height, width, 2);
    LogMap gradient(map.size()), product(map.size());
    const double cost = prior.Evaluate(map, &gradient);
    prior.AddProduct(v, &product);
    EXPECT_GT(cost, 0.0);
    const auto along = [&](float t) {
      LogMap at = map;
      for (int c = 0; c < 3; ++c) at.Plane(c) += t * v.Plane(c);
      return prior.Evaluate(at, nullptr);
    };
    double slope = 0.0, curvature = 0.0;
    for (size_t i = 0; i < v.values().size(); ++i) {
      slope += static_cast<double>(gradient.values()[i]) * v.values()[i];
      curvature += static_cast<double>(product.values()[i]) * v.values()[i];
    }
    // A quadratic: differences are exact but for the float map.
    EXPECT_NEAR((along(0.5f) - along(-0.5f)), slope,
                1e-4 * (std::abs(slope) + cost));
    EXPECT_NEAR(4 * (along(0.5f) - 2 * cost + along(-0.5f)), curvature,
                1e-3 * (curvature + cost));
  }
}

// With blocks of one texel the covariance is that of the maps that
// ProcessIllumination draws: both by unit vectors.
TEST(ProcessPrior, PrecisionIsOfTheMapsThatAreDrawn) {
  const int height = 8, width = 16, n = 3 * height * width;
  const LightHyperparameters hyperparameters = {0.4, {1.0, 0.5, 1.2, 0.8}};
  const std::vector<Eigen::Vector3d> directional_lights = {
      MapDirection(3.4, 5.3, height, width),
      MapDirection(1.7, 11.7, height, width)};
  ASSERT_FALSE(
      NearDirectionalLights(directional_lights, height, width).empty());
  const ProcessPrior prior(height, width, LightProcess(), hyperparameters, 0.0,
                           directional_lights);
  const std::unique_ptr<IlluminationModel> drawn = MakeProcessIllumination(
      width, height, LightProcess(), hyperparameters, directional_lights);
  const Eigen::MatrixXd S = testing::JacobianOf(drawn.get());
  Eigen::MatrixXd precision(n, n);
  LogMap unit({width, height});
  for (int i = 0; i < n; ++i) {
    unit.data()[i] = 1.0f;
    LogMap column(unit.size());
    prior.AddProduct(unit, &column);
    unit.data()[i] = 0.0f;
    precision.col(i) =
        Eigen::Map<const Eigen::VectorXf>(column.data(), n).cast<double>();
  }
  // The precision in float has an error of its largest entries in all
  // directions; of rough light that is far less than what the directional
  // lights change.
  const Eigen::MatrixXd identity = S.transpose() * precision * S;
  const Eigen::MatrixXd projector = identity * identity;
  const double rounding =
      6e-8 * S.squaredNorm() * precision.cwiseAbs().maxCoeff();
  EXPECT_LT((projector - identity).cwiseAbs().maxCoeff(), rounding);
  // A projector can be zero.
  EXPECT_NEAR(n, identity.trace(), std::sqrt(n) * rounding);
}

// Blocks of sides that do not halve are as few as any other map's.
TEST(ProcessPrior, CostHardlyDependsOnTheMapsSize) {
  const auto cost = [](int height, int width) {
    std::vector<float> map;
    for (int c = 0; c < 3; ++c) {
      for (int t = 0; t < height * width; ++t) {
        map.push_back(static_cast<float>(
            MapDirection(t / width + 0.5, t % width + 0.5, height, width).y()));
      }
    }
    return ProcessPrior(height, width, LightProcess(), {}, 0.0)
        .Evaluate(LogMap({width, height}, map), nullptr);
  };
  const double even = cost(128, 256);
  EXPECT_GT(even, 0.0);
  EXPECT_NEAR(even, cost(127, 254), 0.1 * even);
}

TEST(ProcessPrior, ConstantMapAtTheLevelCostsNothing) {
  ProcessPrior prior(32, 64, LightProcess(), {}, -0.7);
  const auto cost = [&](const std::vector<float>& values) {
    return prior.Evaluate(LogMap({64, 32}, values), nullptr);
  };
  std::vector<float> map(3 * 32 * 64, -0.7f);
  EXPECT_NEAR(0.0, cost(map), 1e-6);
  // Another grey level costs little, a colour cast of the same size more.
  std::vector<float> grey = map, red = map;
  for (float& v : grey) v += 1.0f;
  for (size_t i = 0; i < red.size(); ++i) {
    red[i] += i < red.size() / 3 ? 1.0f : -0.5f;
  }
  EXPECT_LT(2 * cost(grey), cost(red));
}

}  // namespace
}  // namespace ibrdf
