#include "ibrdf/solvers/priors/determined_directions.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

namespace ibrdf {
namespace {

constexpr int kSize = 6;

Eigen::MatrixXd RandomMatrix(unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> g;
  Eigen::MatrixXd out(kSize, kSize);
  for (Eigen::Index i = 0; i < out.size(); ++i) out.data()[i] = g(rng);
  return out;
}

MaterialPrior PriorOf(const Eigen::MatrixXd& covariance) {
  MaterialPrior prior;
  prior.mean = Eigen::VectorXd::Zero(kSize);
  prior.factor = covariance.llt().matrixL();
  return prior;
}

std::vector<double> ToVector(const Eigen::MatrixXd& m) {
  return {m.data(), m.data() + m.size()};
}

// Data that measure some directions alone: along them the variance that is left
// is 1 / (1 + s), along the others all of it.
TEST(DeterminedDirections, AreThoseThatTheDataMeasure) {
  const Eigen::MatrixXd a = RandomMatrix(1);
  const Eigen::MatrixXd prior = a * a.transpose();
  // Columns that the prior has as independent, of variance 1.
  const Eigen::MatrixXd whitened =
      Eigen::MatrixXd(prior.llt().matrixL()).inverse();
  Eigen::MatrixXd information = prior.inverse();
  const double strengths[] = {1000.0, 99.0, 1.0};
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd row = whitened.row(k).transpose();
    information += strengths[k] * row * row.transpose();
  }
  const auto found =
      FindDeterminedDirections(PriorOf(prior), ToVector(information.inverse()));
  ASSERT_TRUE(found.has_value());
  const double expected[] = {1 / 1001.0, 0.01, 0.5, 1.0, 1.0, 1.0};
  for (int i = 0; i < kSize; ++i) {
    EXPECT_NEAR(expected[i], found->variance_left[i], 1e-8);
  }
  EXPECT_EQ(2, found->num_determined());
  EXPECT_NEAR(1000.0 / 1001 + 0.99 + 0.5, found->degrees_of_freedom(), 1e-7);
  EXPECT_NEAR(0.5 * std::log(1001.0 * 100 * 2), found->information(), 1e-6);
}

// The directions are of the distributions, not of the parameters' units.
TEST(DeterminedDirections, DoNotDependOnCoordinates) {
  const Eigen::MatrixXd a = RandomMatrix(2), b = RandomMatrix(3);
  const Eigen::MatrixXd prior = a * a.transpose();
  const Eigen::MatrixXd posterior =
      (prior.inverse() + b * b.transpose()).inverse();
  const Eigen::MatrixXd turn = RandomMatrix(4);
  const auto found =
      FindDeterminedDirections(PriorOf(prior), ToVector(posterior));
  const auto turned =
      FindDeterminedDirections(PriorOf(turn * prior * turn.transpose()),
                               ToVector(turn * posterior * turn.transpose()));
  ASSERT_TRUE(found && turned);
  for (int i = 0; i < kSize; ++i) {
    EXPECT_NEAR(found->variance_left[i], turned->variance_left[i], 1e-7);
  }
}

TEST(DeterminedDirections, OfNothingAreNone) {
  const MaterialPrior prior = PriorOf(Eigen::MatrixXd::Identity(kSize, kSize));
  EXPECT_FALSE(FindDeterminedDirections(prior, {}).has_value());
  std::vector<double> bad(kSize * kSize,
                          std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(FindDeterminedDirections(prior, bad).has_value());
  const auto same = FindDeterminedDirections(
      prior, ToVector(Eigen::MatrixXd::Identity(kSize, kSize)));
  ASSERT_TRUE(same.has_value());
  EXPECT_EQ(0, same->num_determined());
  EXPECT_NEAR(0.0, same->information(), 1e-12);
}

}  // namespace
}  // namespace ibrdf
