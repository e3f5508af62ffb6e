#include "ibrdf/solvers/estimation/marginal_search.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/solve/ball_problem.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A noisy ball in a smooth, unknown light.
class MarginalSearchTest : public ::testing::Test {
 protected:
  MarginalSearchTest() : problem_(BallProblem(16)) {
    problem_.solver.max_iterations = 2;
    problem_.model =
        std::make_shared<const NeuralBrdfModel>(SmoothTinyModel(3));
    SetNoisyImage(
        BallRadiance(problem_, *problem_.model, TinyLobes(), SmoothMap(8, 16)),
        0.02, &problem_);
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
  }

  // The best optimum's candidates, and how many stages the trace has of a
  // second search.
  std::vector<MaterialCandidate> Search(const SearchAgain& again,
                                        int* of_second) {
    SolveContext context(problem_, SolveProgress(), nullptr);
    const auto found = EstimateReflectances({setup_.get()}, &context, again);
    EXPECT_TRUE(found.ok()) << found.status().message();
    *of_second = 0;
    for (const TraceEntry& entry : context.trace()) {
      *of_second += entry.stage.rfind("second search: ", 0) == 0 ? 1 : 0;
    }
    return found->front().estimate.candidates;
  }

  InverseProblem problem_;
  std::unique_ptr<const SolveSetup> setup_;
};

TEST_F(MarginalSearchTest, WhatTheFirstFindsDecidesOnASecondSearch) {
  int stages = 0, asked = 0;
  const std::vector<MaterialCandidate> once = Search({}, &stages);
  EXPECT_EQ(0, stages);
  const std::vector<MaterialCandidate> settled = Search(
      [&](const std::vector<ModelOptima>& found) {
        ++asked;
        EXPECT_EQ(once.front().parameters,
                  found.front().estimate.candidates.front().parameters);
        return false;
      },
      &stages);
  EXPECT_EQ(1, asked);
  EXPECT_EQ(0, stages);
  EXPECT_EQ(once.front().parameters, settled.front().parameters);
  const std::vector<MaterialCandidate> twice = Search(
      [&](const std::vector<ModelOptima>&) {
        ++asked;
        return true;
      },
      &stages);
  EXPECT_EQ(2, asked);
  EXPECT_GT(stages, 2);
  EXPECT_LE(twice.front().cost, once.front().cost);
}

}  // namespace
}  // namespace ibrdf
