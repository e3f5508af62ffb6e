#include "ibrdf/solvers/priors/ambient_prior.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/solvers/priors/ambient_prior_cost.h"

namespace ibrdf {
namespace {

AmbientPrior Example() {
  AmbientPrior prior;
  prior.mean = {0.1, 2e-9, 3e4};
  prior.deviation = {0.02, 1e-9, 1e5};
  return prior;
}

TEST(AmbientPrior, CostIsHalfTheSquaresOfItsResiduals) {
  const AmbientPrior prior = Example();
  const AmbientPriorCost cost(prior);
  const Eigen::Array3d ambient(0.14, 0.0, 1.3e5);
  Eigen::Array3d residuals;
  const double* const blocks[] = {ambient.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, residuals.data(), nullptr));
  EXPECT_NEAR(2.0, residuals[0], 1e-12);
  EXPECT_NEAR(-2.0, residuals[1], 1e-12);
  EXPECT_NEAR(1.0, residuals[2], 1e-12);
  EXPECT_NEAR(prior.Cost(ambient), residuals.square().sum() / 2, 1e-12);
}

TEST(AmbientPrior, JacobianMatchesDifferences) {
  const AmbientPrior prior = Example();
  const AmbientPriorCost cost(prior);
  for (const double away : {0.0, 1.0, 1e6}) {
    const Eigen::Array3d ambient = prior.mean + away * prior.deviation;
    Eigen::Array3d at;
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> J;
    const double* blocks[] = {ambient.data()};
    double* jacobians[] = {J.data()};
    ASSERT_TRUE(cost.Evaluate(blocks, at.data(), jacobians));
    for (int c = 0; c < 3; ++c) {
      Eigen::Array3d moved = ambient, r;
      moved[c] += prior.deviation[c];
      blocks[0] = moved.data();
      ASSERT_TRUE(cost.Evaluate(blocks, r.data(), nullptr));
      for (int row = 0; row < 3; ++row) {
        // A step of one deviation changes one residual by 1.
        EXPECT_NEAR((r[row] - at[row]) / prior.deviation[c], J(row, c),
                    1e-9 / prior.deviation[c]);
      }
    }
  }
}

TEST(AmbientPrior, OfNoDeviationCostsNothing) {
  AmbientPrior prior;
  prior.mean.setConstant(3.0);
  EXPECT_FALSE(prior.unknown());
  EXPECT_EQ(0.0, prior.Cost(Eigen::Array3d::Constant(7.0)));
}

}  // namespace
}  // namespace ibrdf
