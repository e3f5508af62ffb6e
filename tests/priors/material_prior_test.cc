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

// Two lobes and a Lambertian one of so many materials. Its red follows the
// first lobe's.
NeuralBrdfModel LambertianModel(int materials) {
  NeuralBrdfModel model = TinyModel(materials);
  model.fit_lobes = 2;
  model.fit_lambertian = true;
  for (int m = 0; m < materials; ++m) {
    for (int i = 0; i < 17; ++i) {
      model.lobe_fits.push_back(0.3f * std::sin(static_cast<float>(m * i)));
    }
    model.lobe_fits[m * 17 + 14] = model.lobe_fits[m * 17 + 4];
  }
  return model;
}

TEST(MaterialPrior, CostAndResidualsAgreeInsideAndBeyondTheBall) {
  const NeuralBrdfModel model = TinyModel(8);
  for (const MaterialPrior& prior :
       {JointMaterialPrior(model, 2, 0.5), BallPrior(model, 2, 0.5),
        JointMaterialPrior(LambertianModel(8), 2, 0.5)}) {
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
      for (const Eigen::Index i :
           {Eigen::Index{0}, Eigen::Index{6}, Eigen::Index{9}, x.size() - 1}) {
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

TEST(MaterialPrior, FindsAMaterialByName) {
  MaterialPrior prior;
  prior.materials = {{"felt", Eigen::VectorXd::Constant(2, 1.0)},
                     {"steel", Eigen::VectorXd::Constant(2, 2.0)}};
  ASSERT_NE(nullptr, prior.Find("steel"));
  EXPECT_EQ(2.0, prior.Find("steel")->parameters[0]);
  EXPECT_EQ(nullptr, prior.Find("stee"));
  EXPECT_EQ(nullptr, MaterialPrior().Find("steel"));
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

TEST(MaterialPrior, KnowsHowALambertianLobeGoesWithTheOthers) {
  const NeuralBrdfModel model = LambertianModel(40);
  const LobeLayout layout = {3, 4, true};
  EXPECT_EQ(layout, FittedLayout(model, 2));
  const MaterialPrior prior = JointMaterialPrior(model, 2, 0.5);
  EXPECT_EQ(layout, prior.layout());
  Eigen::VectorXd together = Eigen::VectorXd::Zero(17), apart = together;
  const double std = prior.factor.row(4).norm();
  together[4] = together[14] = apart[4] = std;
  apart[14] = -std;
  EXPECT_LT(prior.Cost(prior.mean + together, nullptr),
            0.5 * prior.Cost(prior.mean + apart, nullptr));
  for (const MaterialPrior::Material& m : prior.materials) {
    EXPECT_EQ(17, m.parameters.size());
  }
  // However dark: a finite cost, which pulls it back.
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(17);
  Eigen::VectorXd dark = prior.mean;
  dark.tail(3).setConstant(-1e3);
  EXPECT_TRUE(std::isfinite(prior.Cost(dark, &gradient)));
  for (int c = 0; c < 3; ++c) EXPECT_LT(gradient[14 + c], 0.0);
}

TEST(MaterialPrior, LambertianLobeStaysLastBesideMoreLobesThanTheFits) {
  const NeuralBrdfModel model = LambertianModel(40);
  const MaterialPrior two = JointMaterialPrior(model, 2, 0.5);
  const MaterialPrior three = JointMaterialPrior(model, 3, 0.5);
  ASSERT_EQ((LobeLayout{4, 4, true}), three.layout());
  // The third lobe is its own; the others are as they were.
  EXPECT_EQ(0.0, three.factor.block(14, 0, 7, 14).norm());
  EXPECT_EQ(0.0, three.factor.block(21, 14, 3, 7).norm());
  EXPECT_EQ(two.mean.tail(3), three.mean.tail(3));
  EXPECT_EQ(two.factor.topLeftCorner(14, 14),
            three.factor.topLeftCorner(14, 14));
  EXPECT_EQ(two.factor.bottomLeftCorner(3, 14),
            three.factor.bottomLeftCorner(3, 14));
  EXPECT_EQ(two.factor.bottomRightCorner(3, 3),
            three.factor.bottomRightCorner(3, 3));
  for (int m = 0; m < 40; ++m) {
    const Eigen::VectorXd& x = three.materials[m].parameters;
    const Eigen::VectorXd& of_two = two.materials[m].parameters;
    ASSERT_EQ(24, x.size());
    EXPECT_EQ(of_two.head(14), x.head(14));
    EXPECT_EQ(of_two.tail(3), x.tail(3));
    EXPECT_FLOAT_EQ(of_two[11] - 3.0, x[18]);
  }
}

// As published, and of fewer lobes than were fitted.
TEST(MaterialPrior, LambertianLobeCanBeLeftOut) {
  const NeuralBrdfModel model = LambertianModel(40);
  const MaterialPrior with = JointMaterialPrior(model, 2, 0.5);
  const MaterialPrior without =
      JointMaterialPrior(model, LobeLayout{2, 4}, 0.5);
  EXPECT_EQ((LobeLayout{2, 4}), without.layout());
  EXPECT_EQ(with.mean.head(14), without.mean);
  EXPECT_LT((with.factor.topLeftCorner(14, 14) - without.factor).norm(), 1e-12);
  EXPECT_EQ(with.materials[5].parameters.head(14),
            without.materials[5].parameters);
  EXPECT_EQ((LobeLayout{1, 4}), JointMaterialPrior(model, 1, 0.5).layout());
  EXPECT_EQ((LobeLayout{2, 4}), BallPrior(model, 2, 0.5).layout());
  EXPECT_EQ((LobeLayout{2, 4}), FittedLayout(TinyModel(40), 2));
}

}  // namespace
}  // namespace ibrdf
