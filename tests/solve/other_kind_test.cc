#include "ibrdf/solvers/solve/other_kind.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/solvers/solve/joint_turns.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A ball with noise in a smooth light, and a search that came to the wrong one
// of two reflectances, or to the right one.
class OtherKindTest : public ::testing::Test {
 protected:
  OtherKindTest() : problem_(BallProblem(20)) {
    problem_.solver.max_iterations = 60;
    problem_.solver.turns = 2;
    SetNoisyImage(
        BallRadiance(problem_, *problem_.model, truth_, SmoothMap(8, 16)), 0.02,
        &problem_);
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
    found_.setup = setup_.get();
    found_.gauge = std::make_shared<const LevelGauge>(*problem_.model,
                                                      setup_->materials, 1);
    context_ = std::make_unique<SolveContext>(problem_, progress_, nullptr);
    found_.gauge->Fix(truth_.data());
    found_.gauge->Fix(wrong_.data());
  }

  Estimate EstimateLightOf(const std::vector<double>& lobes) const {
    ReflectanceEstimate reflectance;
    reflectance.lobes = reflectance.initial_lobes = lobes;
    return EstimateLight(*setup_, std::move(reflectance), context_.get())
        .value();
  }
  void AddCoarse(const std::vector<double>& lobes, double cost,
                 const std::string& name = "coarse") {
    CoarseOptimum optimum;
    optimum.name = name;
    optimum.cost = cost;
    optimum.parameters = lobes;
    found_.estimate.coarse_optima.push_back(optimum);
  }
  // The gauge rounds.
  static void ExpectNear(const std::vector<double>& a,
                         const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-6) << k;
  }
  std::optional<RevisedReflectance> Find(const Estimate& estimate) {
    return FindOtherKind(found_, estimate, context_.get()).value();
  }

  std::vector<double> truth_ = {0.3,  -0.4, 0.2, 0.1,  5.0, 4.6, 4.2,
                                -0.5, 0.1,  0.3, -0.2, 3.0, 3.5, 3.3};
  // It has another code, and a log-RMSE of more than 0.5 from the truth.
  std::vector<double> wrong_ = {-0.8, 0.5, 0.2, 0.1,  5.0, 4.6, 4.2,
                                -0.5, 0.1, 0.3, -0.2, 3.0, 3.5, 3.3};
  const SolveProgress progress_;
  InverseProblem problem_;
  std::unique_ptr<const SolveSetup> setup_;
  ModelOptima found_;
  std::unique_ptr<SolveContext> context_;
};

TEST_F(OtherKindTest, TheReflectanceOfTheImageTakesThePlaceOfAWrongOne) {
  AddCoarse(wrong_, 0.0);
  AddCoarse(truth_, 50.0);
  const auto other = Find(EstimateLightOf(wrong_));
  ASSERT_TRUE(other.has_value());
  ExpectNear(truth_, other->lobes);
  EXPECT_EQ((MapSize{16, 8}), other->log_map.size());
  ASSERT_TRUE(other->light.has_value());
  EXPECT_GT(other->light->log_std.num_pixels(), 0u);
  // No material is called so.
  EXPECT_EQ("", other->initial_guess);
  // What takes seconds is told.
  const std::vector<TraceEntry>& trace = context_->trace();
  ASSERT_LE(2u, trace.size());
  EXPECT_EQ("hold the estimate", trace[trace.size() - 2].stage);
  EXPECT_EQ("hold coarse", trace.back().stage);
  EXPECT_LT(trace.back().cost, trace[trace.size() - 2].cost);
}

TEST_F(OtherKindTest, TheReflectanceOfTheImageKeepsItsPlace) {
  AddCoarse(truth_, 0.0);
  AddCoarse(wrong_, 1.0);
  EXPECT_FALSE(Find(EstimateLightOf(truth_)).has_value());
}

TEST_F(OtherKindTest, WhatTheSearchGaveUpRightlyIsNotAsked) {
  AddCoarse(wrong_, 0.0);
  AddCoarse(truth_, 1000.0);
  EXPECT_FALSE(Find(EstimateLightOf(wrong_)).has_value());
}

TEST_F(OtherKindTest, WithoutTimeOrOptimaThereIsNone) {
  const Estimate wrong = EstimateLightOf(wrong_);
  EXPECT_FALSE(Find(wrong).has_value());
  AddCoarse(truth_, 0.0);
  problem_.solver.seconds = 1e-9;
  context_ = std::make_unique<SolveContext>(problem_, progress_, nullptr);
  EXPECT_FALSE(Find(wrong).has_value());
}

// And the solve goes on from there, with its light.
TEST_F(OtherKindTest, AThoroughSearchAsksBeforeTheFirstTurn) {
  AddCoarse(truth_, 0.0);
  problem_.solver.search = SolverSearch::kThorough;
  const Estimate wrong = EstimateLightOf(wrong_);
  const auto taken = JointTurns(found_, context_.get()).Take(wrong);
  ASSERT_TRUE(taken.ok());
  ASSERT_TRUE(taken->has_value());
  ExpectNear(truth_, (*taken)->lobes);

  problem_.solver.search = SolverSearch::kAuto;
  const auto turned = JointTurns(found_, context_.get()).Take(wrong);
  ASSERT_TRUE(turned.ok());
  ASSERT_TRUE(turned->has_value());
  EXPECT_NE(truth_, (*turned)->lobes);
  EXPECT_FALSE((*turned)->light.has_value());
}

TEST_F(OtherKindTest, TheEstimateHasItsLobesItsLightAndItsBeginning) {
  const MaterialPrior::Material& material = setup_->materials.materials.back();
  AddCoarse(truth_, 0.0, material.name);
  ReflectanceEstimate reflectance;
  reflectance.lobes = reflectance.initial_lobes = wrong_;
  int calls = 0;
  const Estimate after =
      EstimateLight(*setup_, std::move(reflectance), context_.get(),
                    [&](const Estimate& so_far)
                        -> StatusOr<std::optional<RevisedReflectance>> {
                      if (++calls > 1) return {std::nullopt};
                      return Find(so_far);
                    })
          .value();
  ExpectNear(truth_, after.reflectance.lobes);
  EXPECT_GT(after.reflectance.light.log_std.num_pixels(), 0u);
  EXPECT_EQ(material.name, after.reflectance.initial_guess);
  std::vector<double> initial(
      material.parameters.data(),
      material.parameters.data() + material.parameters.size());
  found_.gauge->Fix(initial.data());
  EXPECT_EQ(initial, after.reflectance.initial_lobes);
  EXPECT_EQ(initial, after.reference.state.lobes);
  EXPECT_LT(Evaluate("", *setup_, *context_, after.iterate, after.pixels.get())
                .misfit,
            0.025);
}

}  // namespace
}  // namespace ibrdf
