#include "solvers/conditioning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

TEST(ScaledCondition, IsThatOfCorrelations) {
  // Two unknowns of correlation r: (1 + r) / (1 - r), whatever their units.
  for (const double r : {0.0, 0.5, -0.9}) {
    for (const double unit : {1.0, 1e-6, 1e6}) {
      Eigen::MatrixXd m(2, 2);
      m << unit * unit, unit * r, unit * r, 1.0;
      EXPECT_NEAR((1 + std::abs(r)) / (1 - std::abs(r)), ScaledCondition(m),
                  1e-9);
    }
  }
  const Eigen::VectorXd diagonal = Eigen::Vector3d(1e-9, 1.0, 1e9);
  EXPECT_NEAR(1.0, ScaledCondition(diagonal.asDiagonal()), 1e-12);
}

TEST(ScaledCondition, NamesWhatHasNone) {
  const Eigen::MatrixXd same = Eigen::MatrixXd::Ones(3, 3);
  EXPECT_TRUE(std::isinf(ScaledCondition(same)));
  Eigen::MatrixXd zero = Eigen::MatrixXd::Identity(3, 3);
  zero(1, 1) = 0.0;
  EXPECT_TRUE(std::isnan(ScaledCondition(zero)));
  zero(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(ScaledCondition(zero)));
  EXPECT_TRUE(std::isnan(ScaledCondition({})));
}

}  // namespace
}  // namespace ibrdf
