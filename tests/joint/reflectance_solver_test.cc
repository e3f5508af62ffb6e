#include "ibrdf/solvers/joint/reflectance_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/solvers/priors/embedding_prior.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// 1/2 sum of squared residuals of the prior.
double LobePriorCostValue(const LobeModel& lobes, const LobePrior& prior,
                          const std::vector<double>& parameters) {
  const LobePriorCost cost(lobes.layout(), prior);
  std::vector<double> residuals(cost.num_residuals());
  const double* blocks[] = {parameters.data()};
  cost.Evaluate(blocks, residuals.data(), nullptr);
  double sum = 0.0;
  for (const double r : residuals) sum += r * r;
  return sum / 2;
}

class ReflectanceSolverTest : public ::testing::Test {
 protected:
  ReflectanceSolverTest() {
    options_.likelihood.epsilon = 1e-6;
    options_.prior.sigma = 0.5;
    for (double& m : options_.prior.colour_mean) m = 4.0;
  }
  double Solve(std::vector<double>* parameters) const {
    return SolveReflectance(scene_.transport, scene_.lobes, map_, observed_,
                            options_, parameters);
  }
  // The objective, from its definition.
  double Cost(const std::vector<double>& parameters) const {
    const std::vector<double> L_o = scene_.Render(parameters, map_);
    double sum = LobePriorCostValue(scene_.lobes, options_.prior, parameters);
    for (size_t i = 0; i < L_o.size(); ++i) {
      if (!observed_.valid[i / 3]) continue;
      const double r = RobustResidual(
          (std::log(L_o[i] + options_.likelihood.epsilon) -
           std::log(observed_.radiance[i] + options_.likelihood.epsilon)) /
              options_.likelihood.scale,
          options_.likelihood.delta, nullptr);
      sum += r * r / 2;
    }
    return sum;
  }
  double Misfit(const std::vector<double>& parameters) const {
    const std::vector<double> L_o = scene_.Render(parameters, map_);
    double sum = 0.0;
    for (size_t i = 0; i < L_o.size(); ++i) {
      sum += std::abs(std::log(L_o[i] / observed_.radiance[i]));
    }
    return sum / static_cast<double>(L_o.size());
  }

  const TinyScene scene_;
  const std::vector<float> map_ = SmoothMap(8, 16).rgb;
  const std::vector<double> truth_ = scene_.Parameters();
  const Observations observed_ = MakeObservations(scene_.Render(truth_, map_));
  ReflectanceStepOptions options_;
};

TEST_F(ReflectanceSolverTest, FindsStrayLightWithTheLobes) {
  const std::vector<double> L_o = scene_.Render(truth_, map_);
  double level = 0.0;
  for (const double v : L_o) level += v / static_cast<double>(L_o.size());
  const Eigen::Array3d truth = level * Eigen::Array3d(0.3, 0.1, 0.0);
  std::vector<double> radiance = L_o;
  for (size_t i = 0; i < L_o.size(); ++i) radiance[i] += truth[i % 3];
  const Observations observed = MakeObservations(radiance);
  AmbientPrior prior;
  prior.mean = truth + 0.05 * level;
  prior.deviation.setConstant(0.1 * level);
  options_.ambient = &prior;
  options_.likelihood.scale = 0.003;
  options_.max_iterations = 50;
  std::vector<double> p = truth_;
  Eigen::Array3d ambient = prior.mean;
  SolveReflectance(scene_.transport, scene_.lobes, map_, observed, options_, &p,
                   &ambient);
  EXPECT_TRUE((ambient >= 0.0).all());
  for (int c = 0; c < 3; ++c) {
    // Darker lobes in more stray light differ by little.
    EXPECT_NEAR(truth[c], ambient[c], 0.02 * level) << c;
  }
}

// Two float renders of one model, by fields and by their sum, over b = 0.02.
constexpr double kCostRounding = 1e-3;

TEST_F(ReflectanceSolverTest, CostNeverRisesAndIsTheOneReturned) {
  for (const double away : {0.0, 0.3, 1.0, 6.0}) {
    for (const double scale : {0.003, 0.2}) {
      options_.likelihood.scale = scale;
      options_.max_iterations = 2;
      std::vector<double> p = truth_;
      for (size_t i = 0; i < p.size(); ++i) p[i] += away * std::sin(3.0 * i);
      double before = Cost(p);
      for (int round = 0; round < 4; ++round) {
        const double after = Solve(&p);
        EXPECT_LE(after, before * (1 + kCostRounding)) << away << " " << scale;
        EXPECT_NEAR(Cost(p), after, kCostRounding * after + 0.1);
        before = after;
      }
    }
  }
}

TEST_F(ReflectanceSolverTest, FitsANoiseFreeImageOfItsOwnModel) {
  options_.max_iterations = 200;
  options_.tolerance = 1e-8;
  options_.likelihood.scale = 0.005;
  // A prior too weak to pull. From near by: back to the lobes that made the
  // image.
  options_.prior.sigma = 50.0;
  options_.prior.colour_sigma = 200.0;
  std::vector<double> p = truth_;
  for (double& v : p) v += 0.1;
  ASSERT_GT(Misfit(p), 0.05);
  EXPECT_LE(Solve(&p), Cost(truth_) * (1 + kCostRounding));
  EXPECT_LT(Misfit(p), 0.02 * options_.likelihood.scale);
  // From afar two lobes have other minima: this local solver need not leave
  // them, yet most of the misfit must go.
  p = truth_;
  for (const int d : {0, 1, 2, 3, 7, 8, 9, 10}) p[d] *= 0.2;
  for (const int c : {4, 5, 6, 11, 12, 13}) p[c] -= 1.0;
  const double before = Misfit(p);
  ASSERT_GT(before, 0.5);
  Solve(&p);
  EXPECT_LT(Misfit(p), before / 20);
  for (int k = 0; k < 2; ++k) {
    double square = 0.0;
    for (int d = 0; d < 4; ++d) square += p[7 * k + d] * p[7 * k + d];
    EXPECT_LT(square, 1.1);  // the wall holds
  }
}

TEST_F(ReflectanceSolverTest, CodesBeyondTheBallComeBack) {
  std::vector<double> p = truth_;
  p[0] = 3.0;
  options_.max_iterations = 30;
  Solve(&p);
  double square = 0.0;
  for (int d = 0; d < 4; ++d) square += p[d] * p[d];
  EXPECT_LT(std::sqrt(square), 1.1);
}

TEST_F(ReflectanceSolverTest, StopEndsAtTheStart) {
  options_.should_stop = [] { return true; };
  std::vector<double> p = truth_;
  p[4] += 1.0;
  const std::vector<double> start = p;
  Solve(&p);
  EXPECT_EQ(start, p);
}

TEST_F(ReflectanceSolverTest, InfeasibleStartIsLeftAsItIs) {
  const std::vector<float> blinding(map_.size(), 3e38f);
  std::vector<double> p = truth_;
  SolveReflectance(scene_.transport, scene_.lobes, blinding, observed_,
                   options_, &p);
  EXPECT_EQ(truth_, p);
}

TEST(EmbeddingPrior, IsMeanAndSpreadOfTheColours) {
  NeuralBrdfModel model = TinyModel(2);
  model.log_colours = {1, 2, 3, 5, 6, 7};
  const LobePrior prior = EmbeddingPrior(model, 0.25);
  EXPECT_EQ(0.25, prior.sigma);
  for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(3.0 + c, prior.colour_mean[c]);
  EXPECT_NEAR(std::sqrt((9 + 4 + 1) * 2 / 6.0), prior.colour_sigma, 1e-12);
}

TEST(EmbeddingPrior, SpreadMaterialsAreDistinctAndStartInTheMiddle) {
  NeuralBrdfModel model = TinyModel(4);
  // Mean codes on the first axis at 0.4, -0.5, 0.1, 0.6.
  const float at[4] = {0.4f, -0.5f, 0.1f, 0.6f};
  for (size_t i = 0; i < model.codes.size(); ++i) {
    model.codes[i] = i % 4 == 0 ? at[i / 12] : 0.0f;
  }
  std::vector<std::string> names;
  for (const MaterialCode& m : SpreadMaterials(model, 3))
    names.push_back(m.name);
  EXPECT_EQ((std::vector<std::string>{"m2", "m1", "m3"}), names);
  EXPECT_EQ(size_t{4}, SpreadMaterials(model, 99).size());
}

}  // namespace
}  // namespace ibrdf
