#include "ibrdf/solvers/illumination/log_map_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <random>

#include "ibrdf/solvers/illumination/process_illumination.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kHeight = 8, kWidth = 16, kTexels = kHeight * kWidth;
const LightHyperparameters kHyperparameters = LightHyperparameters::Average();

LogMap SmoothLogMap() {
  const Image map = SmoothMap(kHeight, kWidth);
  std::vector<float> out(3 * kTexels);
  for (int i = 0; i < 3 * kTexels; ++i) {
    out[i] = std::log(map.rgb[3 * (i % kTexels) + i / kTexels]);
  }
  return {{kWidth, kHeight}, out};
}

double Weight(int i, double sigma) {
  return TexelSolidAngle(i % kTexels / kWidth, kHeight, kWidth) /
         TexelSolidAngle(kHeight / 2, kHeight, kWidth) / (sigma * sigma);
}

// The cost by its definition.
double CostOf(const LogMap& target, double sigma,
              const std::vector<float>& mean, const std::vector<float>& p,
              IlluminationModel* model) {
  LogMap map;
  model->Forward(p.data(), &map);
  const std::vector<float> std = model->PriorStd();
  double cost = 0.0;
  for (size_t i = 0; i < map.values().size(); ++i) {
    const double d = double{map.values()[i]} - target.values()[i];
    cost += 0.5 * Weight(static_cast<int>(i), sigma) * d * d;
  }
  for (size_t i = 0; i < p.size(); ++i) {
    const double d = (double{p[i]} - mean[i]) / std[i];
    cost += 0.5 * d * d;
  }
  return cost;
}

double RmsError(const LogMap& target, const std::vector<float>& p,
                IlluminationModel* model) {
  LogMap map;
  model->Forward(p.data(), &map);
  double sum = 0.0;
  for (size_t i = 0; i < map.values().size(); ++i) {
    const double d = double{map.values()[i]} - target.values()[i];
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(map.values().size()));
}

class LogMapFitTest : public ::testing::TestWithParam<bool> {
 protected:
  const std::unique_ptr<IlluminationModel> model_ =
      GetParam() ? MakeUnetIllumination(TinyUnetOptions())
                 : MakeProcessIllumination(kWidth, kHeight, LightProcess(),
                                           kHyperparameters);
  std::vector<float> Start() const {
    const double level[3] = {0.2, 0.1, -0.5};
    return model_->ConstantMap(level);
  }
  const LogMap target_ = SmoothLogMap();
};

// Runs of more and more iterations go along one path.
TEST_P(LogMapFitTest, CostNeverRisesAndIsTheOneReturned) {
  for (const double sigma : {0.01, 0.2, 3.0}) {
    LogMapFitOptions options;
    options.sigma = sigma;
    options.tolerance = 0.0;
    const std::vector<float> start = Start();
    const double at_start = CostOf(target_, sigma, start, start, model_.get());
    double before = at_start;
    for (const int iterations : {0, 1, 2, 3, 5, 8}) {
      options.max_iterations = iterations;
      std::vector<float> p = start;
      const double cost = FitLogMap(target_, options, model_.get(), &p);
      EXPECT_LE(cost, before);
      // The same sum of doubles in another order.
      EXPECT_NEAR(CostOf(target_, sigma, start, p, model_.get()), cost,
                  1e-12 * at_start);
      before = cost;
    }
    // A sigma above the map's own spread leaves the prior its say.
    EXPECT_LT(before, (sigma < 1.0 ? 0.5 : 1.0) * at_start) << sigma;
  }
}

TEST_P(LogMapFitTest, StartAtTheTargetStays) {
  const std::vector<float> start = Start();
  std::vector<float> p = start;
  LogMap target;
  model_->Forward(p.data(), &target);
  EXPECT_EQ(0.0, FitLogMap(target, {}, model_.get(), &p));
  EXPECT_EQ(start, p);
}

TEST_P(LogMapFitTest, StopsWhenAsked) {
  const std::vector<float> start = Start();
  LogMapFitOptions options;
  options.tolerance = 0.0;
  std::vector<float> stopped = start;
  options.should_stop = [] { return true; };
  const double cost = FitLogMap(target_, options, model_.get(), &stopped);
  EXPECT_EQ(start, stopped);
  EXPECT_NEAR(CostOf(target_, options.sigma, start, start, model_.get()), cost,
              1e-12 * cost);
  // In the midst: what was reached is kept.
  int asked = 0;
  options.should_stop = [&] { return ++asked > 2; };
  FitLogMap(target_, options, model_.get(), &stopped);
  options.should_stop = nullptr;
  options.max_iterations = 2;
  std::vector<float> two = start;
  FitLogMap(target_, options, model_.get(), &two);
  EXPECT_EQ(two, stopped);
  EXPECT_NE(start, two);
}

INSTANTIATE_TEST_SUITE_P(Models, LogMapFitTest, ::testing::Bool(),
                         [](const ::testing::TestParamInfo<bool>& p) {
                           return p.param ? "Unet" : "Process";
                         });

// A linear model with a Gaussian prior: min over w of the cost is
// 1/2 r^T (K + D)^-1 r, r = target - map at the start, D = 1 / weights.
TEST(LogMapFitOfTheProcess, ReachesTheMinimumInClosedForm) {
  const std::unique_ptr<IlluminationModel> model = MakeProcessIllumination(
      kWidth, kHeight, LightProcess(), kHyperparameters);
  const LogMap target = SmoothLogMap();
  const double level[3] = {0.2, 0.1, -0.5};
  const std::vector<float> start = model->ConstantMap(level);
  const LightProcess process;
  const RowMatrix correlation =
      LightCorrelation(kHeight, kWidth, process, kHyperparameters);
  for (const double sigma : {0.05, 0.2}) {
    Eigen::MatrixXd covariance(3 * kTexels, 3 * kTexels);
    Eigen::VectorXd r(3 * kTexels);
    for (int c = 0; c < 3; ++c) {
      for (int d = 0; d < 3; ++d) {
        covariance.block(c * kTexels, d * kTexels, kTexels, kTexels) =
            (process.Local()(c, d) * correlation).array() +
            process.Level()(c, d);
      }
    }
    for (int i = 0; i < 3 * kTexels; ++i) {
      covariance(i, i) += 1.0 / Weight(i, sigma);
      r[i] = target.values()[i] - level[i / kTexels];
    }
    const double least = 0.5 * r.dot(covariance.llt().solve(r));
    LogMapFitOptions options;
    options.sigma = sigma;
    options.max_iterations = 30;
    options.max_cg_iterations = 200;
    options.tolerance = 1e-7;
    std::vector<float> p = start;
    const double cost = FitLogMap(target, options, model.get(), &p);
    // Float maps, whose roundings over sigma are 1e-5 of a residual.
    EXPECT_GT(cost, least * (1 - 1e-4));
    EXPECT_LT(cost, least * (1 + 1e-3));
  }
}

// The prior holds each texel back by its own pull times sigma^2: less than the
// root of a smooth map's prior cost, some 0.1 of sigma when that is small.
TEST(LogMapFitOfTheProcess, FitsASmoothMapFarBelowSigma) {
  const std::unique_ptr<IlluminationModel> model = MakeProcessIllumination(
      kWidth, kHeight, LightProcess(), kHyperparameters);
  const LogMap target = SmoothLogMap();
  const double level[3] = {0.2, 0.1, -0.5};
  double before = 1.0;
  for (const double sigma : {0.2, 0.02}) {
    LogMapFitOptions options;
    options.sigma = sigma;
    std::vector<float> p = model->ConstantMap(level);
    FitLogMap(target, options, model.get(), &p);
    const double error = RmsError(target, p, model.get());
    EXPECT_LT(error, sigma / 3);
    EXPECT_LT(error, before / 10);  // faster than sigma itself
    before = error;
  }
  EXPECT_LT(before, 0.02 / 8);
}

}  // namespace
}  // namespace ibrdf
