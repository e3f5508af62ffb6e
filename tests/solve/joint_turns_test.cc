#include "ibrdf/solvers/solve/joint_turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/solve/residual_statistics.h"
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
    SetNoisyImage(
        BallRadiance(problem_, *problem_.model, truth_, SmoothMap(8, 16)), 0.05,
        &problem_);
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
    gauge_ = std::make_shared<const LevelGauge>(*problem_.model,
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
  StatusOr<std::optional<RevisedReflectance>> TakeAfter(
      const Estimate& estimate) {
    return JointTurns({setup_.get(), gauge_, {}}, context_.get())
        .Take(estimate);
  }
  // The map under the wrong reflectance, which may be found anew on the way.
  Estimate WithTurns() {
    JointTurns turns({setup_.get(), gauge_, {}}, context_.get());
    ReflectanceEstimate reflectance;
    reflectance.lobes = reflectance.initial_lobes = Wrong();
    gauge_->Fix(reflectance.lobes.data());
    return EstimateLight(*setup_, std::move(reflectance), context_.get(),
                         [&turns](const Estimate& e) { return turns.Take(e); })
        .value();
  }
  // The first material of the model, far from the truth.
  std::vector<double> Wrong() const {
    const auto& parameters = setup_->materials.materials.front().parameters;
    return {parameters.data(), parameters.data() + parameters.size()};
  }
  // The ratio is of radiance to the image's, by channel.
  Eigen::Array3d MeanLogRatio(const std::vector<double>& lobes,
                              const LogMap& log_map) const {
    std::vector<float> map;
    log_map.Exp(&map);
    std::vector<double> L_o(3 * problem_.points.size());
    Transport(problem_.points, 8, 16, problem_.transport)
        .Render(setup_->lobes->Grid(lobes.data()), map.data(), L_o.data());
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (size_t i = 0; i < L_o.size(); ++i) {
      const size_t pixel = problem_.points[i / 3].pixel;
      sum[i % 3] += std::log(L_o[i] / problem_.image.rgb[3 * pixel + i % 3]);
    }
    return sum / static_cast<double>(problem_.points.size());
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
  std::shared_ptr<const LevelGauge> gauge_;
  std::unique_ptr<SolveContext> context_;
};

TEST_F(JointTurnsTest, CorrelationTellsNoiseFromWhatIsNotExplained) {
  const double explained =
      ResidualStatisticsOf(*setup_, EstimateLightOf(truth_)).correlation;
  EXPECT_GE(explained, -1.0);
  EXPECT_LT(explained, 0.3);
  Estimate wrong = EstimateLightOf(Wrong());
  std::fill(wrong.iterate.state.light.begin(), wrong.iterate.state.light.end(),
            0.0f);
  const double constant_light =
      ResidualStatisticsOf(*setup_, wrong).correlation;
  EXPECT_GT(constant_light, 0.6);
  EXPECT_LE(constant_light, 1.0);
}

TEST_F(JointTurnsTest, WhatIsExplainedIsLeftAsItIs) {
  const Estimate estimate = EstimateLightOf(truth_);
  const size_t lines = context_->trace().size();
  const auto after = TakeAfter(estimate);
  ASSERT_TRUE(after.ok());
  EXPECT_FALSE(after->has_value());
  EXPECT_EQ(lines, context_->trace().size());
}

TEST_F(JointTurnsTest, AReflectanceFoundAnewIsAtTheLevelOfTheMaterials) {
  const Estimate estimate = EstimateLightOf(Wrong());
  ASSERT_GT(ResidualStatisticsOf(*setup_, estimate).correlation, 0.35);
  const auto after = TakeAfter(estimate);
  ASSERT_TRUE(after.ok());
  ASSERT_TRUE(after->has_value());
  std::vector<double> lobes = (*after)->lobes;
  EXPECT_NE(estimate.iterate.state.lobes, lobes);
  EXPECT_NEAR(0.0, gauge_->Fix(lobes.data()), 1e-6);
  ASSERT_EQ((MapSize{16, 8}), (*after)->log_map.size());
  const Eigen::Array3d level = MeanLogRatio((*after)->lobes, (*after)->log_map);
  EXPECT_LT(level.abs().maxCoeff(), 0.05);
}

TEST_F(JointTurnsTest, AWrongReflectanceIsFoundAnewOnTheWayToTheMap) {
  const Estimate wrong = EstimateLightOf(Wrong());
  const Estimate turned = WithTurns();
  EXPECT_LT(Misfit(turned), 0.95 * Misfit(wrong));
  EXPECT_NE(wrong.iterate.state.lobes, turned.iterate.state.lobes);
  EXPECT_EQ(turned.reflectance.lobes, turned.iterate.state.lobes);
}

// The image is as bright after a revision as before: what the lobes lose the
// map has.
TEST_F(JointTurnsTest, TheMapTakesTheLevelThatTheLobesLose) {
  ReflectanceEstimate reflectance;
  reflectance.lobes = reflectance.initial_lobes = truth_;
  double before = 0.0;
  int calls = 0;
  const StatusOr<Estimate> after = EstimateLight(
      *setup_, std::move(reflectance), context_.get(),
      [&](const Estimate& so_far)
          -> StatusOr<std::optional<RevisedReflectance>> {
        if (++calls == 2) {
          // The last line of the trace is of the map after the revision.
          EXPECT_LT(context_->trace().back().misfit, 1.05 * before);
          return std::optional<RevisedReflectance>();
        }
        before = Misfit(so_far);
        RevisedReflectance darker;
        darker.lobes = so_far.iterate.state.lobes;
        for (const size_t k : {4, 5, 6, 11, 12, 13}) darker.lobes[k] -= 1.5;
        darker.log_map = LogMapOf(so_far.iterate);
        for (size_t k = 0; k < darker.log_map.values().size(); ++k) {
          darker.log_map.data()[k] += 1.5f;
        }
        return std::optional<RevisedReflectance>(std::move(darker));
      });
  ASSERT_TRUE(after.ok());
  EXPECT_EQ(2, calls);
  EXPECT_LT(Misfit(*after), 1.05 * before);
}

TEST_F(JointTurnsTest, NoRevisionIsNoneToTheLastBit) {
  problem_.solver.tolerance = 1e-7;
  const Estimate plain = EstimateLightOf(Wrong());
  ReflectanceEstimate reflectance;
  reflectance.lobes = reflectance.initial_lobes = Wrong();
  gauge_->Fix(reflectance.lobes.data());
  int calls = 0;
  const StatusOr<Estimate> asked = EstimateLight(
      *setup_, std::move(reflectance), context_.get(), [&](const Estimate&) {
        ++calls;
        return StatusOr<std::optional<RevisedReflectance>>(std::nullopt);
      });
  ASSERT_TRUE(asked.ok());
  EXPECT_EQ(1, calls);
  // More iterations follow than those before the question.
  EXPECT_GT(std::stoi(context_->trace().back().stage.substr(14)), 5);
  EXPECT_EQ(plain.iterate.state.light, asked->iterate.state.light);
  EXPECT_EQ(plain.iterate.scale, asked->iterate.scale);
}

TEST_F(JointTurnsTest, AFailedRevisionIsTheEstimatesStatus) {
  ReflectanceEstimate reflectance;
  reflectance.lobes = reflectance.initial_lobes = truth_;
  const StatusOr<Estimate> failed = EstimateLight(
      *setup_, std::move(reflectance), context_.get(), [](const Estimate&) {
        return StatusOr<std::optional<RevisedReflectance>>(
            InvalidInput("turn", "of no use"));
      });
  EXPECT_EQ(StatusCode::kInvalidInput, failed.status().code());
}

TEST_F(JointTurnsTest, NoneAreTakenThatNobodyAskedFor) {
  problem_.solver.turns = 0;
  const auto after = TakeAfter(EstimateLightOf(Wrong()));
  ASSERT_TRUE(after.ok());
  EXPECT_FALSE(after->has_value());
}

TEST_F(JointTurnsTest, WithoutTimeNothingIsTried) {
  const Estimate estimate = EstimateLightOf(Wrong());
  context_->Reserve(1e7);
  const auto after = TakeAfter(estimate);
  ASSERT_TRUE(after.ok());
  EXPECT_FALSE(after->has_value());
}

}  // namespace
}  // namespace ibrdf
