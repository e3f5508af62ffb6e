#include "ibrdf/solvers/priors/light_process.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace ibrdf {
namespace {

// No band is like another.
constexpr LightHyperparameters kRough = {0.3, {-1.5, 0.4, -0.3, 0.8}};

TEST(LightProcess, ScalesAreWhitened) {
  const LightHyperparameters hyperparameters = kRough;
  const auto y = hyperparameters.Whitened();
  const LightHyperparameters back =
      LightHyperparameters::FromWhitened(y.data());
  EXPECT_NEAR(hyperparameters.log_amplitude, back.log_amplitude, 1e-14);
  for (int b = 0; b < LightHyperparameters::kBands; ++b) {
    EXPECT_NEAR(hyperparameters.log_roughness[b], back.log_roughness[b], 1e-14);
  }
  for (const double mean : LightHyperparameters().Whitened())
    EXPECT_EQ(0.0, mean);
}

TEST(LightProcess, HarshLightIsADeviationAboveTheMean) {
  for (const double y : LightHyperparameters::Harsh().Whitened()) {
    EXPECT_NEAR(1.0, y, 1e-12);
  }
}

TEST(LightProcess, RoughnessIsLinearBetweenItsKnots) {
  const int height = 180;
  const RowMatrix weights = RoughnessWeights(height);
  EXPECT_NEAR(height, weights.sum(), 1e-12);
  EXPECT_GE(weights.minCoeff(), 0.0);
  const Eigen::VectorXd S = Roughness(height, kRough);
  // Rows are of half degrees.
  EXPECT_NEAR(-1.5, std::log(S[0]), 1e-12);
  EXPECT_NEAR(0.8, std::log(S[height - 1]), 1e-12);
  const double half_way = (57.5 - 40.0) / (75.0 - 40.0);
  EXPECT_NEAR(-1.5 + half_way * 1.9, std::log(S[57]), 1e-12);
}

TEST(LightProcess, HorizonIsAStepThatNoAmplitudeScales) {
  const LightProcess process;
  LightProcess without = process;
  without.horizon_share = 0.0;
  for (const double log_amplitude : {-3.0, 0.0, 1.5}) {
    const LightHyperparameters hyperparameters{log_amplitude,
                                               LightHyperparameters::kMean};
    const RowMatrix step = std::exp(log_amplitude) *
                           (LightCorrelation(8, 16, process, hyperparameters) -
                            LightCorrelation(8, 16, without, hyperparameters));
    for (int i = 0; i < step.rows(); ++i) {
      for (int j = 0; j < step.cols(); ++j) {
        const double side = (i < 4 * 16) == (j < 4 * 16) ? 0.25 : -0.25;
        ASSERT_NEAR(process.horizon_share * side, step(i, j), 1e-12);
      }
    }
  }
  // The horizon halves the middle row of an odd number.
  EXPECT_EQ(Eigen::Vector3d(0.5, 0.0, -0.5), HorizonStep(3));
}

TEST(LightProcess, CovariancesArePositive) {
  const LightProcess process;
  // Smooth everywhere, and nowhere.
  for (const double rough : {-8.0, 0.0, 3.0}) {
    const RowMatrix C =
        LightCorrelation(8, 16, process, {0.0, {rough, -rough, rough, 0.0}});
    EXPECT_EQ(Eigen::Success, Eigen::LLT<Eigen::MatrixXd>(C).info()) << rough;
  }
  EXPECT_EQ(Eigen::Success,
            Eigen::LLT<Eigen::Matrix3d>(process.Local()).info());
  EXPECT_DOUBLE_EQ(0.0, process.VarianceWithin(0.0));
  EXPECT_LT(process.VarianceWithin(5.0), process.VarianceWithin(10.0));
}

}  // namespace
}  // namespace ibrdf
