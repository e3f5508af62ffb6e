#include "ibrdf/solvers/solve/reflectance_band.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/base/pi.h"
#include "ibrdf/base/quantile.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/solvers/solve/reflectance_samples.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class ReflectanceBandTest : public ::testing::Test {
 protected:
  ReflectanceBandTest()
      : model_(SmoothTinyModel(2)),
        factory_(FlowLobes::Factory(model_, 2, 1)),
        lobes_(factory_({4, 4, 2})),
        parameters_(TinyLobes()) {
    parameters_.resize(lobes_->num_parameters());
  }
  // Small and correlated: B B^T.
  Eigen::MatrixXd Root(double scale) const {
    const auto n = static_cast<Eigen::Index>(parameters_.size());
    Eigen::MatrixXd root(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        root(i, j) = scale * std::sin(1.0 + 3.0 * i + 7.0 * j);
      }
    }
    return root;
  }
  std::vector<double> Covariance(double scale) const {
    const Eigen::MatrixXd C = Root(scale) * Root(scale).transpose();
    return {C.data(), C.data() + C.size()};
  }

  NeuralBrdfModel model_;
  LobeFactory factory_;
  std::unique_ptr<const LobeModel> lobes_;
  std::vector<double> parameters_;
};

// The slow reference: many samples by another root of the covariance, each
// evaluated through tables of its own at the slice's angles.
TEST_F(ReflectanceBandTest, HasThePercentilesOfSamples) {
  constexpr double kScale = 0.02;
  constexpr int kSamples = 4000;
  const std::vector<BrdfSlice> slices =
      ReflectanceBand(factory_, parameters_, Covariance(kScale), 2000, 7);
  ASSERT_EQ(3u, slices.size());
  const Eigen::MatrixXd root = Root(kScale);
  std::mt19937_64 rng(11);
  std::normal_distribution<double> gauss;
  const auto grid_lobes = factory_({40, 13, 2});
  // theta_h of the third slice is 0; of it five angles, in three channels.
  std::vector<std::vector<double>> values(15);
  for (int k = 0; k < kSamples; ++k) {
    std::vector<double> x = parameters_;
    Eigen::VectorXd z(root.cols());
    for (double& v : z) v = gauss(rng);
    const Eigen::VectorXd step = root * z;
    for (size_t i = 0; i < x.size(); ++i) x[i] += step[i];
    const BrdfGrid grid = grid_lobes->Grid(x.data());
    for (int j = 0; j < 5; ++j) {
      const Eigen::Array3d f =
          grid.Evaluate(0.0, slices[2].degrees[2 * j] * kPi / 180.0, kPi / 2);
      for (int c = 0; c < 3; ++c) values[3 * j + c].push_back(f[c]);
    }
  }
  for (int j = 0; j < 5; ++j) {
    for (int c = 0; c < 3; ++c) {
      const double low = Quantile(values[3 * j + c], 0.05);
      const double high = Quantile(values[3 * j + c], 0.95);
      // Ends of bands of some thousand samples are known to a tenth of them.
      const double error = 0.1 * (high - low);
      EXPECT_NEAR(low, slices[2].low[c][2 * j], error);
      EXPECT_NEAR(high, slices[2].high[c][2 * j], error);
    }
  }
}

TEST_F(ReflectanceBandTest, HoldsTheEstimateAtItsAngles) {
  const std::vector<BrdfSlice> slices =
      ReflectanceBand(factory_, parameters_, Covariance(0.02), 200, 7);
  const MerlTable table = lobes_->ToMerl(parameters_.data());
  for (const BrdfSlice& slice : slices) {
    for (size_t i = 0; i < slice.degrees.size(); ++i) {
      EXPECT_TRUE(i == 0 || slice.degrees[i] > slice.degrees[i - 1]);
      for (int c = 0; c < 3; ++c) {
        EXPECT_LT(slice.low[c][i], slice.value[c][i]);
        EXPECT_LT(slice.value[c][i], slice.high[c][i]);
      }
    }
  }
  EXPECT_EQ(0.0, slices[0].degrees.front());
  EXPECT_NEAR(90.0, slices[0].degrees.back(), 0.5);
  EXPECT_NEAR(45.0, slices[2].degrees[6], 1e-6);
  // Where two slices meet they agree.
  EXPECT_EQ(slices[1].value[0][0], slices[2].value[0][6]);
  EXPECT_EQ(slices[0].high[2][0], slices[2].high[2][0]);
}

// A posterior of which the level alone is unknown has a wide band, and one of
// no width once samples are brought to the estimate's level.
TEST_F(ReflectanceBandTest, LevelIsTakenOutWhereNoImageTellsIt) {
  const auto n = static_cast<Eigen::Index>(parameters_.size());
  Eigen::VectorXd level = Eigen::VectorXd::Zero(n);
  const MutableLobeMixture colours = lobes_->Mixture(level.data());
  for (int k = 0; k < lobes_->num_lobes(); ++k) {
    for (int c = 0; c < 3; ++c) colours.log_colour(k)[c] = 0.3 + 0.1 * c;
  }
  const Eigen::MatrixXd C = level * level.transpose();
  const std::vector<double> covariance(C.data(), C.data() + C.size());
  const LobeDistance distance(factory_, {18, 8, 8});
  const auto width = [&](const LobeDistance* align) {
    double widest = 0.0;
    for (const BrdfSlice& slice :
         ReflectanceBand(factory_, parameters_, covariance, 200, 7, align)) {
      for (int c = 0; c < 3; ++c) {
        for (size_t i = 0; i < slice.degrees.size(); ++i) {
          widest =
              std::max(widest, std::log(slice.high[c][i] / slice.low[c][i]));
        }
      }
    }
    return widest;
  };
  // 2 * 1.64 deviations of the widest channel, 0.5.
  EXPECT_NEAR(1.64, width(nullptr), 0.25);
  EXPECT_LT(width(&distance), 1e-3);
}

// The slow reference: the same samples, each scaled as the metrics do it, by
// the mean log difference of whole tables.
TEST_F(ReflectanceBandTest, AlignsSamplesAsTheMetricsDo) {
  constexpr int kSamples = 12;
  const std::vector<double> covariance = Covariance(0.05);
  const LobeDistance distance(factory_, {18, 8, 8});
  const std::vector<BrdfSlice> slices = ReflectanceBand(
      factory_, parameters_, covariance, kSamples, 7, &distance);
  const MerlTable estimate = lobes_->ToMerl(parameters_.data());
  const auto grid_lobes = factory_({40, 13, 2});
  std::vector<double> values[3];
  for (const std::vector<double>& sample :
       SampleReflectances(*lobes_, parameters_, covariance, kSamples, 7)) {
    const MerlTable table = lobes_->ToMerl(sample.data());
    const BrdfGrid grid = grid_lobes->Grid(sample.data());
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0, count = 0.0;
      for (int bin = 0; bin < kMerlBins; ++bin) {
        if (!(estimate.Raw(0, bin) > 0.0)) continue;
        sum += std::log((estimate.Raw(c, bin) + 1e-6) /
                        (table.Raw(c, bin) + 1e-6));
        count += 1.0;
      }
      values[c].push_back(std::log(grid.Evaluate(0.0, 0.0, kPi / 2)[c]) +
                          sum / count);
    }
  }
  for (int c = 0; c < 3; ++c) {
    const double low = Quantile(values[c], 0.05);
    const double high = Quantile(values[c], 0.95);
    EXPECT_GT(high - low, 0.1);  // else nothing is compared
    // Scales from a coarse grid and from 90x90x180 bins.
    EXPECT_NEAR(low, std::log(slices[2].low[c][0]), 0.02) << c;
    EXPECT_NEAR(high, std::log(slices[2].high[c][0]), 0.02) << c;
  }
}

TEST_F(ReflectanceBandTest, OfNothingUnknownHasNoWidth) {
  for (const BrdfSlice& slice : ReflectanceBand(
           factory_, parameters_,
           std::vector<double>(parameters_.size() * parameters_.size(), 0.0), 5,
           1)) {
    for (int c = 0; c < 3; ++c) {
      for (size_t i = 0; i < slice.degrees.size(); ++i) {
        EXPECT_FLOAT_EQ(slice.value[c][i], slice.low[c][i]);
        EXPECT_FLOAT_EQ(slice.value[c][i], slice.high[c][i]);
      }
    }
  }
}

TEST_F(ReflectanceBandTest, ExtremesAreFiniteOrEmpty) {
  std::vector<double> covariance = Covariance(0.1);
  covariance[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(
      ReflectanceBand(factory_, parameters_, covariance, 20, 1).empty());
  for (const BrdfSlice& slice :
       ReflectanceBand(factory_, parameters_, Covariance(1e3), 20, 1)) {
    for (int c = 0; c < 3; ++c) {
      for (const double f : slice.high[c]) EXPECT_TRUE(std::isfinite(f));
    }
  }
}

}  // namespace
}  // namespace ibrdf
