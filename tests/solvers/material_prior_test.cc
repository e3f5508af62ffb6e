#include "solvers/material_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "tests/solvers/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class MaterialPriorTest : public ::testing::TestWithParam<double> {
 protected:
  MaterialPriorTest()
      : prior_(JointMaterialPrior(TinyModel(5), 2, 0.5)),
        lobes_(prior_.mean.size()) {
    lobes_ << 0.3, -0.4, 0.2, 0.1, 5.0, 4.6, 4.2,  //
        -0.5, 0.1, 0.9, -0.2, 3.0, 3.5, -3.3;      // beyond the ball
  }

  Eigen::VectorXd AtLevel(double level) const {
    Eigen::VectorXd x = lobes_;
    x.segment<3>(4).array() += level;
    x.segment<3>(11).array() += level;
    return x;
  }

  const MaterialPrior prior_;
  Eigen::VectorXd lobes_;
};

// At ordinary levels and ten orders of magnitude off either way.
TEST_P(MaterialPriorTest, BestLevelIsTheLeastOfAll) {
  double least = prior_.Cost(AtLevel(-10.0), nullptr);
  for (double level = -10.0; level < 10.0; level += 1e-3) {
    least = std::min(least, prior_.Cost(AtLevel(level), nullptr));
  }
  const double best = prior_.CostAtBestLevel(AtLevel(GetParam()));
  EXPECT_LE(best, least * (1 + 1e-9));
  // Of a parabola, within half a step of its lowest point.
  EXPECT_GT(best, least - 1e-4);
  EXPECT_GT(prior_.WallCost(lobes_, nullptr), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Levels, MaterialPriorTest,
                         ::testing::Values(0.0, -1.5, 25.0, -25.0));

}  // namespace
}  // namespace ibrdf
