#include "ibrdf/solvers/estimation/reflectance_given_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/lobe_distance.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kBinsAcross = 8;
constexpr double kDetail = 0.8;  // of log radiance, of a factor of two or so

// A ball whose pixels show detail that the known map does not have: a
// chequerboard, brighter and darker by the same factor.
class ReflectanceGivenLightTest : public ::testing::Test {
 protected:
  ReflectanceGivenLightTest() : problem_(BallProblem(40)) {
    problem_.kind = ProblemKind::kReflectance;
    problem_.model =
        std::make_shared<const NeuralBrdfModel>(SmoothTinyModel(3));
    problem_.known_map = SmoothMap(8, 16);
    std::vector<double> L_o = BallRadiance(problem_, *problem_.model,
                                           TinyLobes(), *problem_.known_map);
    for (size_t i = 0; i < L_o.size(); ++i) {
      const int pixel = problem_.points[i / 3].pixel;
      const int square = pixel % 40 + pixel / 40;
      L_o[i] *= std::exp(square % 2 == 0 ? kDetail : -kDetail);
    }
    SetNoisyImage(L_o, 0.01, &problem_);
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
  }

  // Of the estimate from the truth, log.
  double Error(const Observation& pixels) const {
    SolveContext context(problem_, SolveProgress(), nullptr);
    const Estimate estimate =
        EstimateLobesGivenLight(*setup_, pixels, &context);
    const LobeDistance distance(
        FlowLobes::Factory(*problem_.model, setup_->lobes->layout(), 1));
    return distance.WithLevel(distance.LogValues(estimate.reflectance.lobes),
                              distance.LogValues(TinyLobes()));
  }

  InverseProblem problem_;
  std::unique_ptr<const SolveSetup> setup_;
};

TEST_F(ReflectanceGivenLightTest, MeansOverNormalsLeaveOutWhatNoMapShows) {
  const Observation bins = MeansByNormal(setup_->pixels, kBinsAcross);
  ASSERT_LT(bins.points.size(), setup_->pixels.points.size() / 4);
  const double of_pixels = Error(setup_->pixels), of_bins = Error(bins);
  EXPECT_LT(of_bins, 0.5 * of_pixels) << of_pixels;
}

}  // namespace
}  // namespace ibrdf
