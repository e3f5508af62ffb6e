#include "ibrdf/solvers/solve/joint_turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A ball with noise in a smooth light. Its light is found for some lobes,
// and then turns are taken.
class JointTurnsTest : public ::testing::Test {
 protected:
  static constexpr int kTurnSize = 20;  // pixels a side

  JointTurnsTest() : problem_(BallProblem(kTurnSize)) {
    problem_.solver.max_iterations = 60;
    problem_.solver.turns = 2;
    const FlowLobes lobes(*problem_.model, 2, problem_.transport.grid, 1);
    std::vector<double> L_o(3 * problem_.points.size());
    Transport(problem_.points, 8, 16, problem_.transport)
        .Render(lobes.Grid(truth_.data()), SmoothMap(8, 16).rgb.data(),
                L_o.data());
    std::mt19937 rng(1);
    std::normal_distribution<double> noise(0.0, 0.05);
    for (size_t i = 0; i < L_o.size(); ++i) {
      problem_.image.rgb[3 * problem_.points[i / 3].pixel + i % 3] =
          static_cast<float>(L_o[i] * std::exp(noise(rng)));
    }
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
    gauge_ = std::make_unique<const LevelGauge>(*problem_.model,
                                                setup_->materials, 1);
    context_ = std::make_unique<SolveContext>(problem_, progress_, nullptr);
  }

  Estimate EstimateLightOf(std::vector<double> lobes) const {
    ReflectanceEstimate reflectance;
    gauge_->Fix(lobes.data());
    reflectance.lobes = reflectance.initial_lobes = std::move(lobes);
    return EstimateLight(*setup_, std::move(reflectance), context_.get())
        .value();
  }
  // The first material of the model, far from the truth.
  std::vector<double> Wrong() const {
    const auto& parameters = setup_->materials.materials.front().parameters;
    return {parameters.data(), parameters.data() + parameters.size()};
  }
  double Misfit(const Estimate& estimate) const {
    return Evaluate("", *setup_, *context_, estimate.iterate,
                    estimate.pixels.get())
        .misfit;
  }

  const std::vector<double> truth_ = {0.3,  -0.4, 0.2, 0.1,  5.0, 4.6, 4.2,
                                      -0.5, 0.1,  0.3, -0.2, 3.0, 3.5, 3.3};
  const SolveProgress progress_;
  InverseProblem problem_;
  std::unique_ptr<const SolveSetup> setup_;
  std::unique_ptr<const LevelGauge> gauge_;
  std::unique_ptr<SolveContext> context_;
};

TEST_F(JointTurnsTest, CorrelationTellsNoiseFromWhatIsNotExplained) {
  const double explained =
      ResidualCorrelation(*setup_, EstimateLightOf(truth_));
  EXPECT_GE(explained, -1.0);
  EXPECT_LT(explained, 0.3);
  Estimate wrong = EstimateLightOf(Wrong());
  std::fill(wrong.iterate.state.light.begin(), wrong.iterate.state.light.end(),
            0.0f);
  const double constant_light = ResidualCorrelation(*setup_, wrong);
  EXPECT_GT(constant_light, 0.6);
  EXPECT_LE(constant_light, 1.0);
}

TEST_F(JointTurnsTest, WhatIsExplainedIsLeftAsItIs) {
  Estimate estimate = EstimateLightOf(truth_);
  const std::vector<double> lobes = estimate.iterate.state.lobes;
  const std::vector<float> light = estimate.iterate.state.light;
  const size_t lines = context_->trace().size();
  const StatusOr<Estimate> after =
      TakeJointTurns(*setup_, *gauge_, std::move(estimate), context_.get());
  ASSERT_TRUE(after.ok());
  EXPECT_EQ(lobes, after->iterate.state.lobes);
  EXPECT_EQ(light, after->iterate.state.light);
  EXPECT_EQ(lines, context_->trace().size());
}

TEST_F(JointTurnsTest, AWrongReflectanceIsFoundAnew) {
  Estimate estimate = EstimateLightOf(Wrong());
  ASSERT_GT(ResidualCorrelation(*setup_, estimate), 0.3);
  const std::vector<double> lobes = estimate.iterate.state.lobes;
  const double before = Misfit(estimate);
  const StatusOr<Estimate> after =
      TakeJointTurns(*setup_, *gauge_, std::move(estimate), context_.get());
  ASSERT_TRUE(after.ok());
  EXPECT_LT(Misfit(*after), 0.98 * before);
  EXPECT_NE(lobes, after->iterate.state.lobes);
  // At the level of the materials.
  std::vector<double> found = after->iterate.state.lobes;
  EXPECT_NEAR(0.0, gauge_->Fix(found.data()), 1e-6);
}

TEST_F(JointTurnsTest, NoneAreTakenThatNobodyAskedFor) {
  problem_.solver.turns = 0;
  Estimate estimate = EstimateLightOf(Wrong());
  const std::vector<double> lobes = estimate.iterate.state.lobes;
  const StatusOr<Estimate> after =
      TakeJointTurns(*setup_, *gauge_, std::move(estimate), context_.get());
  ASSERT_TRUE(after.ok());
  EXPECT_EQ(lobes, after->iterate.state.lobes);
}

TEST_F(JointTurnsTest, WithoutTimeNothingIsTried) {
  Estimate estimate = EstimateLightOf(Wrong());
  const std::vector<double> lobes = estimate.iterate.state.lobes;
  context_->Reserve(1e7);
  const StatusOr<Estimate> after =
      TakeJointTurns(*setup_, *gauge_, std::move(estimate), context_.get());
  ASSERT_TRUE(after.ok());
  EXPECT_EQ(lobes, after->iterate.state.lobes);
}

}  // namespace
}  // namespace ibrdf
