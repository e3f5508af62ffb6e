#include "ibrdf/solvers/marginal/view_information.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/marginal/small_light.h"

namespace ibrdf {
namespace {

constexpr int kLights = 2, kSources = kTexels + kLights;
constexpr int kParameters = 5;

// Rows [first, first + count) of all channels' points.
RowMatrix RowsOf(const RowMatrix& all, int points, int first, int count) {
  RowMatrix out(3 * count, all.cols());
  for (int c = 0; c < 3; ++c) {
    out.middleRows(c * count, count) =
        all.middleRows(c * points + first, count);
  }
  return out;
}

// K of all channels, written out.
Eigen::MatrixXd PriorCovariance(const LightProcess& process,
                                const LightHyperparameters& hyperparameters) {
  const RowMatrix C =
      LightCorrelation(kHeight, kWidth, process, hyperparameters);
  const double amplitude = std::exp(hyperparameters.log_amplitude);
  Eigen::MatrixXd K(3 * kSources, 3 * kSources);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      Eigen::MatrixXd local = Eigen::MatrixXd::Zero(kSources, kSources);
      local.topLeftCorner(kTexels, kTexels) =
          amplitude * process.Local()(c, d) * C;
      local.diagonal().tail(kLights).setConstant(
          process.DirectionalLight()(c, d));
      K.block(c * kSources, d * kSources, kSources, kSources) =
          local.array() + process.Level()(c, d);
    }
  }
  return K;
}

double LogDet(const Eigen::MatrixXd& matrix) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(matrix);
  return factor.vectorD().array().log().sum();
}

// The first points are photographed; the others are of views that might be.
class ViewInformationTest : public ::testing::Test {
 protected:
  static constexpr int kAll = 14, kView = 4;  // photographed: kPoints

  ViewInformationTest()
      : T_(Lobes(0.5, kAll, kLights)), G_(3 * kAll, kParameters) {
    std::mt19937_64 rng(5);
    std::normal_distribution<double> g;
    for (Eigen::Index i = 0; i < G_.size(); ++i) G_.data()[i] = 0.3 * g(rng);
    light_ = DrawLight(Proper(), 1.0, 3, kLights);
    for (int c = 0; c < 3; ++c) {
      photographed_[c] = T_[c].topRows(kPoints);
      const Eigen::VectorXd L =
          light_.segment(c * kSources, kSources).array().exp();
      J_[c] = (T_[c] * L).cwiseInverse().asDiagonal() * T_[c] * L.asDiagonal();
    }
    noise_ = Eigen::VectorXd::LinSpaced(3 * kAll, 0.002, 0.02);
  }

  LightMode Mode() const { return {0.0, light_, {}}; }

  LinearPosterior Photographed(LogRadianceData data = {}) const {
    if (data.value.empty()) data.value = LogRadiance(photographed_, light_);
    const MarginalLikelihood likelihood =
        Likelihood(std::move(data), Proper(), kLights);
    return likelihood.Linearised(photographed_,
                                 {RowsOf(noise_, kAll, 0, kPoints), {}},
                                 Rough(), Mode(), RowsOf(G_, kAll, 0, kPoints));
  }

  LogRadianceSlopes View(int first, int count = kView) const {
    LogRadianceSlopes out;
    for (int c = 0; c < 3; ++c) {
      out.by_light[c] = J_[c].middleRows(first, count);
    }
    out.by_parameters = RowsOf(G_, kAll, first, count);
    out.noise = RowsOf(noise_, kAll, first, count);
    return out;
  }

  // Half of log det of the information of some points, the last parameters
  // integrated out, from the covariance of all their data, written out.
  double Dense(const std::vector<int>& points, int nuisance) const {
    const auto n = static_cast<int>(points.size());
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * n, 3 * kSources);
    Eigen::MatrixXd G(3 * n, kParameters),
        D = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < n; ++i) {
        J.block(c * n + i, c * kSources, 1, kSources) = J_[c].row(points[i]);
        G.row(c * n + i) = G_.row(c * kAll + points[i]);
        D(c * n + i, c * n + i) = noise_[c * kAll + points[i]];
      }
    }
    const Eigen::MatrixXd A =
        D + J * PriorCovariance(Proper(), Rough()) * J.transpose();
    const Eigen::MatrixXd information =
        Eigen::MatrixXd::Identity(kParameters, kParameters) +
        G.transpose() * A.inverse() * G;
    const Eigen::MatrixXd covariance = information.inverse();
    const int kept = kParameters - nuisance;
    return -0.5 * LogDet(covariance.topLeftCorner(kept, kept));
  }

  static std::vector<int> Range(int first, int end) {
    std::vector<int> out;
    for (int i = first; i < end; ++i) out.push_back(i);
    return out;
  }

  std::array<RowMatrix, 3> T_, photographed_, J_;
  RowMatrix G_;
  Eigen::VectorXd light_, noise_;
};

// The slow reference: the covariance of all data, written out and inverted.
TEST_F(ViewInformationTest, GainIsThatOfTheDenseCovariance) {
  for (const int nuisance : {0, 2}) {
    ViewInformation information(Photographed(), nuisance);
    const double before = Dense(Range(0, 6), nuisance);
    EXPECT_NEAR(before, information.information(), 1e-8) << nuisance;
    const double with_one = Dense(Range(0, 10), nuisance);
    const double gain = information.Gain(View(6));
    EXPECT_NEAR(with_one - before, gain, 1e-8) << nuisance;
    EXPECT_GT(gain, 0.1) << nuisance;  // nothing is compared where nothing is
    information.Add(View(6));
    EXPECT_NEAR(with_one, information.information(), 1e-8) << nuisance;
    // Beside the view that was taken.
    EXPECT_NEAR(Dense(Range(0, 14), nuisance) - with_one,
                information.Gain(View(10)), 1e-8)
        << nuisance;
  }
}

// What the light's prior says is part of it: with the light known the same
// rows tell more.
TEST_F(ViewInformationTest, UnknownLightCostsInformation) {
  LinearPosterior known = Photographed();
  known.light_covariance.setZero();
  known.light_slope.setZero();
  EXPECT_GT(ViewInformation(known, 0).Gain(View(6)),
            1.5 * ViewInformation(Photographed(), 0).Gain(View(6)));
}

TEST_F(ViewInformationTest, OrderOfViewsDoesNotMatter) {
  ViewInformation one(Photographed(), 2), other(Photographed(), 2);
  one.Add(View(6));
  one.Add(View(10));
  other.Add(View(10));
  other.Add(View(6));
  EXPECT_NEAR(one.information(), other.information(), 1e-8);
}

// No view takes information away. A view that was taken has less to add than
// before, and one that sees nothing adds nothing.
TEST_F(ViewInformationTest, GainsAreNotNegativeAndFall) {
  ViewInformation information(Photographed(), 2);
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k) {
    const double gain = information.Gain(View(6));
    EXPECT_GE(gain, 0.0);
    EXPECT_LT(gain, last);
    last = gain;
    information.Add(View(6));
  }
  LogRadianceSlopes nothing = View(10);
  nothing.by_parameters.setZero();
  for (RowMatrix& J : nothing.by_light) J.setZero();
  EXPECT_NEAR(0.0, information.Gain(nothing), 1e-10);
  nothing.noise.setConstant(1e30);
  EXPECT_NEAR(0.0, information.Gain(nothing), 1e-10);
}

TEST_F(ViewInformationTest, RowsThatAreNotFiniteHaveNoGain) {
  LogRadianceSlopes broken = View(6);
  broken.by_parameters(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const ViewInformation information(Photographed(), 2);
  EXPECT_TRUE(std::isnan(information.Gain(broken)));
  broken = View(6);
  broken.by_light[1](0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(information.Gain(broken)));
}

// Photographs that are bounded from far away say nothing: what a view adds is
// what it says alone.
TEST_F(ViewInformationTest, AmplyBoundedPhotographsSayNothing) {
  LogRadianceData data;
  data.value = LogRadiance(photographed_, light_);
  for (const double y : data.value) {
    data.low.push_back(y - 40.0);
    data.high.push_back(y + 40.0);
  }
  const ViewInformation information(Photographed(data), 0);
  EXPECT_NEAR(0.0, information.information(), 1e-6);
  EXPECT_NEAR(Dense(Range(6, 10), 0), information.Gain(View(6)), 1e-6);
}

}  // namespace
}  // namespace ibrdf
