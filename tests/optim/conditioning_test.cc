#include "ibrdf/solvers/optim/conditioning.h"

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

// All steps of conjugate gradients make all of Lanczos' matrix; fewer see less.
TEST(LanczosCondition, IsThePreconditionedSystems) {
  constexpr int kSize = 12;
  Eigen::VectorXd system(kSize), metric(kSize);
  for (int i = 0; i < kSize; ++i) {
    metric[i] = std::pow(10.0, i - 6);
    system[i] = metric[i] * (1.0 + i * i);  // preconditioned: 1 to 122
  }
  const auto run = [&](int steps) {
    CgCoefficients coefficients;
    const Eigen::VectorXd b = metric.cwiseSqrt();
    const Eigen::VectorXd x = ConjugateGradients(
        [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
          return system.cwiseProduct(v);
        },
        [&](const Eigen::VectorXd& r) -> Eigen::VectorXd {
          return r.cwiseQuotient(metric);
        },
        b, steps, 0.0, &coefficients);
    EXPECT_EQ(static_cast<size_t>(steps), coefficients.alpha.size());
    return LanczosCondition(coefficients);
  };
  EXPECT_NEAR(122.0, run(kSize), 1e-6);
  EXPECT_LT(run(4), 122.0);
  EXPECT_GT(run(4), run(2));
  EXPECT_DOUBLE_EQ(1.0, run(1));
  EXPECT_TRUE(std::isnan(LanczosCondition({})));
}

}  // namespace
}  // namespace ibrdf
