#include "ibrdf/solvers/priors/material_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "ibrdf/solvers/priors/material_prior_cost.h"
#include "tests/support/solver_testing.h"

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
  // The search ends within half a step of a parabola's lowest point.
  EXPECT_GT(best, least - 1e-4);
  EXPECT_GT(prior_.WallCost(lobes_, nullptr), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Levels, MaterialPriorTest,
                         ::testing::Values(0.0, -1.5, 25.0, -25.0));

TEST(MaterialPrior, CostAndResidualsAgreeInsideAndBeyondTheBall) {
  const NeuralBrdfModel model = TinyModel(8);
  for (const MaterialPrior& prior :
       {JointMaterialPrior(model, 2, 0.5), BallPrior(model, 2, 0.5)}) {
    const MaterialPriorCost cost(&prior);
    for (const double scale : {0.0, 0.3, 2.0, 1e3}) {
      Eigen::VectorXd x = prior.mean;
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        x[i] += scale * std::cos(2.0 * i);
      }
      std::vector<double> r(cost.num_residuals()), J(r.size() * x.size());
      const double* block[] = {x.data()};
      double* jacobian[] = {J.data()};
      ASSERT_TRUE(cost.Evaluate(block, r.data(), jacobian));
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
      const double value = prior.Cost(x, &gradient);
      double half = 0.0;
      Eigen::VectorXd by_residuals = Eigen::VectorXd::Zero(x.size());
      for (size_t i = 0; i < r.size(); ++i) {
        half += 0.5 * r[i] * r[i];
        for (Eigen::Index j = 0; j < x.size(); ++j) {
          by_residuals[j] += r[i] * J[i * x.size() + j];
        }
      }
      EXPECT_NEAR(value, half, 1e-9 * (1 + half));
      EXPECT_LT((gradient - by_residuals).norm(), 1e-9 * (1 + gradient.norm()));
      for (const Eigen::Index i : {0, 6, 9}) {
        const double h = 1e-5 * (1 + scale);
        Eigen::VectorXd up = x, down = x;
        up[i] += h;
        down[i] -= h;
        EXPECT_NEAR(
            (prior.Cost(up, nullptr) - prior.Cost(down, nullptr)) / (2 * h),
            gradient[i], 1e-5 * (1 + gradient.norm()));
      }
    }
  }
}

TEST(MaterialPrior, KnowsHowLobesGoTogether) {
  NeuralBrdfModel model = TinyModel(40);
  model.fit_lobes = 2;
  for (int m = 0; m < 40; ++m) {
    for (int i = 0; i < 14; ++i) {
      model.lobe_fits.push_back(0.3f * std::sin(static_cast<float>(m * i)));
    }
    // The second lobe's red follows the first one's.
    model.lobe_fits[m * 14 + 11] = model.lobe_fits[m * 14 + 4];
  }
  const MaterialPrior prior = JointMaterialPrior(model, 2, 0.5);
  Eigen::VectorXd together = Eigen::VectorXd::Zero(14), apart = together;
  const double std = prior.factor.row(4).norm();
  together[4] = together[11] = apart[4] = std;
  apart[11] = -std;
  EXPECT_LT(prior.Cost(prior.mean + together, nullptr),
            0.5 * prior.Cost(prior.mean + apart, nullptr));
  // A third lobe is its own.
  const MaterialPrior three = JointMaterialPrior(model, 3, 0.5);
  ASSERT_EQ(21, three.num_parameters());
  EXPECT_EQ(0.0, three.factor.block(14, 0, 7, 14).norm());
  for (const MaterialPrior::Material& m : three.materials) {
    EXPECT_EQ(21, m.parameters.size());
  }
}

}  // namespace
}  // namespace ibrdf
