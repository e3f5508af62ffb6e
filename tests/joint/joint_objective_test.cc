#include "ibrdf/solvers/joint/joint_objective.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "ibrdf/solvers/joint/compressed_cost.h"
#include "tests/joint/joint_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// The float kernels leave some 1e-6 of L_o; over the steps of about 0.01 that
// Ridders' method settles on, a few 1e-4 of a derivative.
constexpr double kDifferenceTolerance = 1e-3;
// Two sums of one float kernel's products in different order.
constexpr double kRounding = 2e-5;

class JointObjectiveTest
    : public ::testing::TestWithParam<std::tuple<bool, JointBlocks>> {
 protected:
  JointObjectiveTest()
      : scene_(std::get<0>(GetParam())), objective_(scene_.Terms()) {
    objective_.Free(std::get<1>(GetParam()));
  }
  // The vector of f along v from state_.
  template <typename Function>
  Eigen::VectorXd Numeric(const Eigen::VectorXd& v, const Function& f) {
    const std::vector<double> d = Differentiate(
        [&](double t) { return f(objective_.Moved(state_, v, t)); }, 0.1);
    return Eigen::Map<const Eigen::VectorXd>(
        d.data(), static_cast<Eigen::Index>(d.size()));
  }

  JointScene scene_;
  JointObjective objective_;
  const JointState state_ = scene_.State(0.3);
};

TEST_P(JointObjectiveTest, RadianceAndResidualsFollowTheirTangents) {
  ASSERT_TRUE(std::isfinite(objective_.Linearise(state_).total()));
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Eigen::VectorXd v = RandomDirection(objective_, seed);
    const Eigen::VectorXd dL_o = objective_.RadianceJvp(v);
    const Eigen::VectorXd dr = objective_.ResidualJvp(v);
    const Eigen::VectorXd numeric_L_o = Numeric(v, [&](const JointState& s) {
      objective_.Evaluate(s);
      return objective_.radiance();
    });
    EXPECT_LT((dL_o - numeric_L_o).norm(), kDifferenceTolerance * dL_o.norm());
    const Eigen::VectorXd numeric_r = Numeric(v, [&](const JointState& s) {
      objective_.Evaluate(s);
      LikelihoodDerivatives d;
      EvaluateLikelihood(objective_.radiance(), scene_.observed,
                         objective_.terms().likelihood, &d);
      return d.residual;
    });
    EXPECT_LT((dr - numeric_r).norm(), kDifferenceTolerance * dr.norm());
    objective_.Linearise(state_);
  }
}

TEST_P(JointObjectiveTest, GradientsMatchDifferencesAndEachOther) {
  Eigen::VectorXd reverse;
  const JointCost cost = objective_.Gradient(state_, &reverse);
  EXPECT_EQ(cost.total(), objective_.Evaluate(state_).total());
  EXPECT_EQ(cost.total(), objective_.Linearise(state_).total());
  const Eigen::VectorXd forward = objective_.gradient();
  EXPECT_LT((forward - reverse).norm(), kRounding * forward.norm());
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const Eigen::VectorXd v = RandomDirection(objective_, seed);
    const double numeric = Numeric(v, [&](const JointState& s) {
      return std::vector<double>{objective_.Evaluate(s).total()};
    })[0];
    EXPECT_NEAR(numeric, forward.dot(v),
                kDifferenceTolerance *
                    (std::abs(numeric) + forward.cwiseAbs().dot(v.cwiseAbs()) /
                                             std::sqrt(double(v.size()))));
  }
}

TEST_P(JointObjectiveTest, TangentsAndAdjointsAreTransposes) {
  objective_.Linearise(state_);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Eigen::VectorXd v = RandomDirection(objective_, seed);
    const Eigen::VectorXd dL_o = objective_.RadianceJvp(v);
    const Eigen::VectorXd a =
        dL_o.array() * Eigen::ArrayXd::LinSpaced(dL_o.size(), 0.5, 1.5);
    EXPECT_NEAR(a.dot(dL_o), objective_.RadianceVjp(a).dot(v),
                kRounding * a.norm() * dL_o.norm());
    const Eigen::VectorXd dr = objective_.ResidualJvp(v);
    EXPECT_NEAR(dr.squaredNorm(), objective_.ResidualVjp(dr).dot(v),
                kRounding * dr.squaredNorm());
  }
}

TEST_P(JointObjectiveTest, LikelihoodAndPriorsMakeUpTheGradient) {
  objective_.Linearise(state_);
  const Eigen::Map<const Eigen::VectorXd> r(objective_.residuals().data(),
                                            objective_.num_residuals());
  const Eigen::VectorXd sum =
      objective_.ResidualVjp(r) + objective_.PriorGradient();
  EXPECT_LT((objective_.gradient() - sum).norm(), kRounding * sum.norm());
}

// Against the matrix assembled from its definition, whitened.
TEST_P(JointObjectiveTest, ProductIsTheGaussNewtonMatrix) {
  const Eigen::Index n = objective_.size(), m = objective_.num_residuals();
  objective_.Linearise(state_);
  const std::vector<double> L_o = objective_.radiance();
  Eigen::MatrixXd J(m, n), H(n, n), prior(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, i);
    J.col(i) = objective_.RadianceJvp(unit);
    H.col(i) = objective_.Product(unit);
    prior.col(i) = objective_.PriorProduct(unit);
  }
  Eigen::VectorXd w(m);
  const RobustLogLikelihood& l = objective_.terms().likelihood;
  for (Eigen::Index i = 0; i < m; ++i) {
    const double e = L_o[i] + l.epsilon;
    const double t =
        std::log(e / (scene_.observed.radiance[i] + l.epsilon)) / l.scale;
    w[i] = 1 / (l.scale * l.scale * e * e * std::sqrt(t * t + 0.25));
  }
  const Eigen::MatrixXd dense = J.transpose() * w.asDiagonal() * J + prior;
  const double size = dense.norm();
  EXPECT_LT((H - dense).norm(), kRounding * size);
  EXPECT_LT((H - H.transpose()).norm(), kRounding * size);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>((H + H.transpose()) / 2)
          .eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), -kRounding * eigenvalues.maxCoeff());
  const int nl = objective_.num_lobe_parameters();
  if (nl > 0) {
    EXPECT_LT((objective_.LobeHessian() - dense.topLeftCorner(nl, nl)).norm(),
              kRounding * size);
  }
}

TEST_P(JointObjectiveTest, PriorsWithoutTheProcessAreTheirVariances) {
  JointObjective objective(scene_.Terms(false));
  objective.Free(std::get<1>(GetParam()));
  JointState inside = state_;
  inside.lobes = scene_.truth;  // codes where the wall is not
  objective.Linearise(inside);
  const Eigen::VectorXd v = RandomDirection(objective, 8);
  const Eigen::VectorXd expected = objective.InverseVariance().cwiseProduct(v);
  EXPECT_LT((objective.PriorProduct(v) - expected).norm(),
            1e-12 * expected.norm());
}

TEST_P(JointObjectiveTest, CompressionKeepsCostGradientAndMatrix) {
  const CompressedCost cost(&objective_, state_, nullptr);
  const Eigen::VectorXd x = objective_.ToVector(state_);
  std::vector<const double*> blocks;
  std::vector<RowMatrix> J;
  std::vector<double*> jacobians;
  Eigen::Index at = 0;
  for (const int size : cost.parameter_block_sizes()) {
    blocks.push_back(x.data() + at);
    J.emplace_back(cost.num_residuals(), size);
    at += size;
  }
  for (RowMatrix& j : J) jacobians.push_back(j.data());
  Eigen::VectorXd r(cost.num_residuals()), short_r = r;
  ASSERT_TRUE(cost.Evaluate(blocks.data(), r.data(), jacobians.data()));
  ASSERT_TRUE(cost.Evaluate(blocks.data(), short_r.data(), nullptr));
  const double total = objective_.Linearise(state_).total();
  EXPECT_NEAR(total, r.squaredNorm() / 2, 1e-9 * total);
  EXPECT_NEAR(total, short_r.squaredNorm() / 2, 1e-9 * total);
  Eigen::MatrixXd whole(cost.num_residuals(), objective_.size());
  if (J.size() == 2) {
    whole << J[0], J[1];
  } else {
    whole = J[0];
  }
  const Eigen::VectorXd& gradient = objective_.gradient();
  EXPECT_LT((whole.transpose() * r - gradient).norm(),
            kRounding * gradient.norm());
  for (const unsigned seed : {1u, 2u}) {
    const Eigen::VectorXd v = RandomDirection(objective_, seed);
    const double expected = objective_.ResidualJvp(v).squaredNorm() +
                            v.dot(objective_.PriorProduct(v));
    EXPECT_NEAR(expected, (whole * v).squaredNorm(), kRounding * expected);
  }
}

TEST_P(JointObjectiveTest, RadianceThatIsNotFiniteCostsNaN) {
  JointState state = state_;
  std::fill(state.lobes.begin(), state.lobes.end(),
            std::numeric_limits<double>::infinity());
  Eigen::VectorXd gradient;
  EXPECT_FALSE(std::isfinite(objective_.Evaluate(state).total()));
  EXPECT_FALSE(std::isfinite(objective_.Gradient(state, &gradient).total()));
  EXPECT_FALSE(std::isfinite(objective_.Linearise(state).total()));
}

std::string Name(
    const ::testing::TestParamInfo<std::tuple<bool, JointBlocks>>& p) {
  const char* blocks[] = {"Both", "Lobes", "Light"};
  return std::string(std::get<0>(p.param) ? "Unet" : "Free") +
         blocks[static_cast<int>(std::get<1>(p.param))];
}

INSTANTIATE_TEST_SUITE_P(
    Models, JointObjectiveTest,
    ::testing::Combine(::testing::Bool(),
                       ::testing::Values(JointBlocks::kBoth,
                                         JointBlocks::kLobes,
                                         JointBlocks::kLight)),
    Name);

// Forward, in reverse and against differences; as bright as the others, and
// black.
TEST(JointObjective, GradientOfALambertianLobeMatchesDifferences) {
  JointScene scene(false, 8, true);
  JointObjective objective(scene.Terms());
  for (const double moved : {0.0, -50.0, -1000.0}) {
    JointState state = scene.State(0.3);
    for (int c = 0; c < 3; ++c) state.lobes[14 + c] += moved;
    Eigen::VectorXd reverse;
    objective.Gradient(state, &reverse);
    objective.Linearise(state);
    const Eigen::VectorXd forward = objective.gradient();
    ASSERT_TRUE(forward.allFinite());
    EXPECT_LT((forward - reverse).norm(), kRounding * forward.norm());
    for (const int i : {0, 7, 13, 14, 15, 16}) {
      const Eigen::VectorXd v = Eigen::VectorXd::Unit(forward.size(), i);
      const double numeric = Differentiate(
          [&](double t) {
            return std::vector<double>{
                objective.Evaluate(objective.Moved(state, v, t)).total()};
          },
          0.1)[0];
      EXPECT_NEAR(numeric, forward[i],
                  kDifferenceTolerance * (1.0 + std::abs(numeric)))
          << moved << " " << i;
    }
  }
}

TEST(JointObjective, KnownBlocksCostTheSameAsHeldOnes) {
  JointScene scene(false);
  const JointState state{scene.truth, scene.State(0.3).light};
  JointObjective both(scene.Terms()), known_brdf(scene.KnownBrdf());
  // By one render; with the operator of its grid, as a known BRDF has it.
  const double rendered = both.Evaluate(state).likelihood;
  const JointCost a = both.Linearise(state), b = known_brdf.Evaluate(state);
  EXPECT_NEAR(a.likelihood, rendered, kRounding * a.likelihood);
  EXPECT_EQ(a.likelihood, b.likelihood);
  EXPECT_EQ(a.illumination_prior, b.illumination_prior);
  EXPECT_EQ(0.0, b.reflectance_prior);
  JointState smooth = state;
  const std::vector<float> map = SmoothMap(8, 16).rgb;
  for (size_t i = 0; i < map.size(); ++i) {
    smooth.light[i % 3 * 128 + i / 3] = std::log(map[i]);
  }
  JointObjective known_light(scene.KnownLight());
  const JointCost c = known_light.Evaluate(smooth);
  // exp(log(L)) in float.
  EXPECT_NEAR(both.Evaluate(smooth).likelihood, c.likelihood, 1e-4);
  EXPECT_EQ(0.0, c.illumination_prior);
  // The image's own lobes and map.
  EXPECT_LT(c.misfit, 1e-6);
}

// Log radiance is clamped: what a texel beyond does not change, it has no
// derivative in.
TEST(JointObjective, TexelBeyondTheClampHasNoDerivative) {
  JointScene scene(false);
  JointObjective objective(scene.Terms(false));
  JointState state = scene.State(0.1);
  for (float& colour : scene.mean) colour = 0.0f;
  objective.set_light_mean(scene.mean);
  constexpr int kBright = 40, kDark = 50;  // of red
  state.light[kBright] = 61.0f;
  state.light[kDark] = -61.0f;
  JointState moved = state;
  moved.light[kBright] = 62.0f;
  moved.light[kDark] = -62.0f;
  const double before = objective.Evaluate(state).likelihood;
  EXPECT_EQ(before, objective.Evaluate(moved).likelihood);
  ASSERT_TRUE(std::isfinite(before));
  Eigen::VectorXd reverse;
  objective.Gradient(state, &reverse);
  objective.Linearise(state);
  const Eigen::VectorXd prior = objective.PriorGradient();
  const int first = objective.num_lobe_parameters();
  for (const int texel : {kBright, kDark}) {
    EXPECT_EQ(prior[first + texel], reverse[first + texel]);
    EXPECT_EQ(prior[first + texel], objective.gradient()[first + texel]);
    Eigen::VectorXd v = Eigen::VectorXd::Zero(objective.size());
    v[first + texel] = 1.0;
    EXPECT_EQ(0.0, objective.RadianceJvp(v).norm());
  }
}

TEST(JointObjective, MeanAndScaleMayChange) {
  JointScene scene(true);
  JointObjective objective(scene.Terms(false));
  const JointState state = scene.State(0.3);
  const JointCost before = objective.Evaluate(state);
  objective.set_light_mean(state.light);
  RobustLogLikelihood l = objective.terms().likelihood;
  l.scale *= 2;
  objective.set_likelihood(l);
  const JointCost after = objective.Evaluate(state);
  EXPECT_GT(before.illumination_prior, 0.0);
  EXPECT_EQ(0.0, after.illumination_prior);
  EXPECT_LT(after.likelihood, before.likelihood);
  EXPECT_EQ(after.misfit, before.misfit);
}

// Its weights would be of the other likelihood.
TEST(JointObjectiveDeathTest, AnotherLikelihoodLeavesNoPoint) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  JointScene scene(true);
  JointObjective objective(scene.Terms(false));
  objective.Linearise(scene.State(0.3));
  objective.set_likelihood(objective.terms().likelihood);
  EXPECT_DEATH(objective.Product(Eigen::VectorXd::Zero(objective.size())), "");
}

}  // namespace
}  // namespace ibrdf
