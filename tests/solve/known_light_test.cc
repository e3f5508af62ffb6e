#include "ibrdf/solvers/solve/known_light.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/solve/paint_evidence.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A ball under a known smooth light, and a second model.
class KnownLightTest : public ::testing::Test {
 protected:
  KnownLightTest() : problem_(BallProblem(20)) {
    problem_.kind = ProblemKind::kReflectance;
    problem_.known_map = SmoothMap(8, 16);
    problem_.solver.max_iterations = 12;
    other_ = {"other",
              std::make_shared<const NeuralBrdfModel>(SmoothTinyModel(4, 7))};
    problem_.other_models = {other_};
    SetImageOf(*problem_.model, MaterialOf(*problem_.model));
  }

  // The model's last material.
  std::vector<double> MaterialOf(const NeuralBrdfModel& model) const {
    InverseProblem of_model = problem_;
    of_model.image.rgb.assign(of_model.image.rgb.size(), 1.0f);
    of_model.model = std::make_shared<const NeuralBrdfModel>(model);
    const StatusOr<SolveSetup> setup = ibrdf::SetUp(of_model);
    const auto& parameters = setup->materials.materials.back().parameters;
    return {parameters.begin(), parameters.end()};
  }
  // With noise of two per cent.
  void SetImageOf(const NeuralBrdfModel& model,
                  const std::vector<double>& parameters) {
    SetNoisyImage(
        BallRadiance(problem_, model, parameters, *problem_.known_map), 0.02,
        &problem_);
  }
  KnownLightEstimate Run() {
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
    context_ = std::make_unique<SolveContext>(problem_, progress_, nullptr);
    context_->Reserve(reserved_);
    StatusOr<KnownLightEstimate> found =
        EstimateUnderKnownLight(*setup_, context_.get());
    EXPECT_TRUE(found.ok()) << found.status().message();
    return *std::move(found);
  }
  double MisfitOf(const KnownLightEstimate& found) const {
    return Evaluate("", found.SetupOr(*setup_), *context_,
                    found.estimate.iterate, found.estimate.pixels.get())
        .misfit;
  }

  const SolveProgress progress_;
  double reserved_ = 0.0;  // seconds
  InverseProblem problem_;
  NamedModel other_;
  std::unique_ptr<const SolveSetup> setup_;
  std::unique_ptr<SolveContext> context_;
};

TEST_F(KnownLightTest, WhatOneModelExplainsIsSearchedByNoOther) {
  const KnownLightEstimate found = Run();
  ASSERT_EQ(1u, found.models.size());
  EXPECT_EQ("default", found.models.front().name);
  EXPECT_EQ((std::vector<double>{1.0}), found.model_weights);
  EXPECT_EQ(nullptr, found.other.setup);
  EXPECT_GT(found.estimate.reflectance.covariance.size(), 0);
  const double unexplained = found.estimate.reflectance.structured_misfit;
  EXPECT_GE(unexplained, 0.0);
  EXPECT_LT(unexplained, 0.02);
  problem_.other_models.clear();
  const KnownLightEstimate alone = Run();
  EXPECT_TRUE(alone.models.empty());
  EXPECT_EQ(alone.estimate.iterate.state.lobes,
            found.estimate.iterate.state.lobes);
  EXPECT_EQ(alone.estimate.iterate.scale, found.estimate.iterate.scale);
}

TEST_F(KnownLightTest, ABallOfAnotherModelHasItsLobes) {
  SetImageOf(*other_.model, MaterialOf(*other_.model));
  const KnownLightEstimate found = Run();
  ASSERT_EQ(2u, found.models.size());
  EXPECT_EQ("other", found.models.front().name);
  EXPECT_GT(found.model_weights.front(), 0.9);
  EXPECT_NEAR(1.0, found.model_weights[0] + found.model_weights[1], 1e-12);
  ASSERT_NE(nullptr, found.other.setup);
  EXPECT_EQ(static_cast<size_t>(found.other.setup->lobes->num_parameters()),
            found.estimate.iterate.state.lobes.size());
  EXPECT_TRUE(found.other.problem->other_models.empty());
  // The problem's own model says how much one model does not explain.
  EXPECT_GT(found.estimate.reflectance.structured_misfit, 0.02);
  const double with_both = MisfitOf(found);
  problem_.other_models.clear();
  EXPECT_LT(with_both, 0.7 * MisfitOf(Run()));
}

// The mean of twice the same is the same.
TEST_F(KnownLightTest, ModelsThatExplainAsMuchCountAlike) {
  SetImageOf(*other_.model, MaterialOf(*other_.model));
  problem_.other_models = {{"twin", problem_.model}};
  const KnownLightEstimate both = Run();
  ASSERT_EQ(2u, both.models.size());
  EXPECT_NEAR(0.5, both.model_weights[0], 1e-9);
  EXPECT_NEAR(0.5, both.model_weights[1], 1e-9);
  problem_.other_models.clear();
  const KnownLightEstimate alone = Run();
  EXPECT_EQ(alone.estimate.iterate.state.lobes,
            both.estimate.iterate.state.lobes);
}

TEST_F(KnownLightTest, WithoutTimeOrIterationsNoOtherModelIsTried) {
  SetImageOf(*other_.model, MaterialOf(*other_.model));
  reserved_ = 1e7;
  EXPECT_EQ(1u, Run().models.size());
  reserved_ = 0.0;
  problem_.solver.max_iterations = 0;
  EXPECT_EQ(1u, Run().models.size());
}

// An image is judged with the stray light that was found in it.
TEST_F(KnownLightTest, StrayLightIsNoPaint) {
  const float* middle = problem_.image.At(10, 10);
  const Eigen::Array3d ambient =
      2.0 * middle[1] * Eigen::Array3d(0.5, 0.2, 0.8);
  for (const ShadingPoint& point : problem_.points) {
    for (int c = 0; c < 3; ++c) {
      problem_.image.rgb[3 * point.pixel + c] += static_cast<float>(ambient[c]);
    }
  }
  problem_.dark.ambient = 1.05 * ambient;
  problem_.dark.ambient_deviation = 0.2 * ambient;
  const KnownLightEstimate found = Run();
  EXPECT_LT(MisfitOf(found), 0.05);
  EXPECT_FALSE(
      LeftBy(found.SetupOr(*setup_), found.estimate, *context_).MayBePaint());
}

TEST(LeftByOneMaterial, MayBePaintWhereItWouldBeSeen) {
  LeftByOneMaterial left;
  left.misfit = 0.3;
  left.matte = 0.8;
  EXPECT_TRUE(left.IsMuch());
  EXPECT_TRUE(left.MayBePaint());
  left.matte = 0.3;  // a mirror's
  EXPECT_FALSE(left.MayBePaint());
  left.matte = 0.8;
  left.mirrored = 0.95;
  EXPECT_FALSE(left.MayBePaint());
  left.mirrored = 0.0;
  left.misfit = 0.05;
  EXPECT_FALSE(left.MayBePaint());
  EXPECT_FALSE(left.IsMuch());
}

}  // namespace
}  // namespace ibrdf
