#include "ibrdf/solvers/estimation/coarse_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/solvers/joint/reflectance_solver.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr double kScale = 0.02;

// A ball under a known light, lobes on the default grid, which is finer than
// that of the steps.
class CoarseStepsTest : public ::testing::Test {
 protected:
  CoarseStepsTest() : problem_(BallProblem(14)) {
    problem_.kind = ProblemKind::kReflectance;
    problem_.transport.grid = BrdfGridShape();
    problem_.model =
        std::make_shared<const NeuralBrdfModel>(SmoothTinyModel(3));
    problem_.known_map = SmoothMap(8, 16);
    SetNoisyImage(BallRadiance(problem_, *problem_.model, TinyLobes(),
                               *problem_.known_map),
                  0.01, &problem_);
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
    pixels_ = std::make_unique<ObservedPixels>(*setup_, setup_->pixels);
    start_.lobes.assign(setup_->materials.materials[0].parameters.begin(),
                        setup_->materials.materials[0].parameters.end());
  }

  JointCost Cost(const JointState& state, std::vector<double>* radiance) {
    const PosteriorObjective on = ObjectiveOn(
        pixels_.get(), *setup_, LightModel(), LightPriors(), kScale);
    JointCost cost = on.objective->Evaluate(state);
    if (radiance != nullptr) *radiance = on.objective->radiance();
    return cost;
  }
  // Likelihood and prior of the lobes on the problem's grid.
  double Total(const JointState& state) {
    return Cost(state, nullptr).likelihood +
           setup_->materials.Cost(ToEigen(state.lobes), nullptr);
  }
  JointState AfterSteps(int batches, bool correct) {
    CoarseSteps steps(*setup_, setup_->pixels);
    CoarseSteps::Options options;
    options.max_steps = 40;
    options.radius = 300.0;
    options.scale = kScale;
    JointState state = start_;
    Eigen::Array3d ambient = Eigen::Array3d::Zero();
    for (int k = 0; k < batches; ++k) {
      std::vector<double> fine;
      Cost(state, &fine);
      if (!correct) fine = steps.Radiance(state);
      steps.Take(options, fine, &state, &ambient);
    }
    return state;
  }

  InverseProblem problem_;
  std::unique_ptr<const SolveSetup> setup_;
  std::unique_ptr<ObservedPixels> pixels_;
  JointState start_;
};

// The slow reference: all steps on the problem's own grid.
TEST_F(CoarseStepsTest, LeadToTheOptimumOfTheProblemsGrid) {
  ReflectanceStepOptions o;
  o.likelihood = LikelihoodOf(*setup_, kScale);
  o.materials = &setup_->materials;
  o.max_iterations = 200;
  o.trust_region_radius = 300.0;
  o.tolerance = 1e-8;
  JointState fine = start_;
  SolveReflectance(pixels_->TransportFrom(setup_->map_size()), *setup_->lobes,
                   setup_->known_map, pixels_->observed(), o, &fine.lobes,
                   nullptr);
  const double least = Total(fine), first = Total(start_);
  const double corrected = Total(AfterSteps(4, true));
  const double uncorrected = Total(AfterSteps(4, false));
  EXPECT_GT(first - least, 100.0);
  EXPECT_LT(corrected - least, 0.5);
  EXPECT_GT(uncorrected - least, corrected - least);
}

// The ends of intervals move with the radiance between them.
TEST_F(CoarseStepsTest, IntervalsThatAreNarrowGiveTheSameSteps) {
  const JointState exact = AfterSteps(2, true);
  Image low = problem_.image, high = problem_.image;
  for (float& v : low.rgb) v *= 1.0f - 1e-6f;
  for (float& v : high.rgb) v *= 1.0f + 1e-6f;
  problem_.bounds = RadianceBounds{low, high};
  setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
  pixels_ = std::make_unique<ObservedPixels>(*setup_, setup_->pixels);
  ASSERT_FALSE(setup_->pixels.observed.exact());
  const JointState within = AfterSteps(2, true);
  EXPECT_NEAR(Total(exact), Total(within), 0.05);
}

// A light that reaches nothing leaves no radiance to correct by.
TEST_F(CoarseStepsTest, BlackRadianceCorrectsNothing) {
  CoarseSteps steps(*setup_, setup_->pixels);
  CoarseSteps::Options options;
  options.max_steps = 3;
  options.radius = 10.0;
  options.scale = kScale;
  const size_t values = 3 * pixels_->points().size();
  for (const double value : {0.0, -1.0, std::nan("")}) {
    JointState state = start_;
    Eigen::Array3d ambient = Eigen::Array3d::Zero();
    steps.Take(options, std::vector<double>(values, value), &state, &ambient);
    for (const double x : state.lobes) EXPECT_TRUE(std::isfinite(x)) << value;
  }
}

}  // namespace
}  // namespace ibrdf
