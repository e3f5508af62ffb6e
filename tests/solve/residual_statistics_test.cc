#include "ibrdf/solvers/solve/residual_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A ball under a known smooth light, and an estimate that is the truth.
class ResidualStatisticsTest : public ::testing::Test {
 protected:
  ResidualStatisticsTest() : problem_(BallProblem(40)) {
    problem_.kind = ProblemKind::kReflectance;
    problem_.known_map = SmoothMap(8, 16);
    L_o_ = BallRadiance(problem_, *problem_.model, truth_, *problem_.known_map);
    estimate_.iterate.state.lobes = truth_;
  }
  // log_ratio(point): of the image to the estimate's radiance.
  template <typename LogRatio>
  ResidualStatistics Of(LogRatio log_ratio) {
    for (size_t i = 0; i < L_o_.size(); ++i) {
      const int pixel = problem_.points[i / 3].pixel;
      problem_.image.rgb[3 * pixel + i % 3] =
          static_cast<float>(L_o_[i] * std::exp(log_ratio(pixel)));
    }
    return ResidualStatisticsOf(*ibrdf::SetUp(problem_), estimate_);
  }

  const std::vector<double> truth_ = {0.3,  -0.4, 0.2, 0.1,  5.0, 4.6, 4.2,
                                      -0.5, 0.1,  0.3, -0.2, 3.0, 3.5, 3.3};
  InverseProblem problem_;
  std::vector<double> L_o_;
  Estimate estimate_;
};

TEST_F(ResidualStatisticsTest, OfNoise) {
  std::mt19937 rng(1);
  std::normal_distribution<double> noise(0.0, 0.05);
  const ResidualStatistics left = Of([&](int) { return noise(rng); });
  // E |x| of a normal variable; 3700 values.
  EXPECT_NEAR(0.05 * std::sqrt(2.0 / kPi), left.misfit, 2e-3);
  EXPECT_NEAR(0.0, left.correlation, 0.08);
}

TEST_F(ResidualStatisticsTest, OfARenderAreThoseOfItsEstimate) {
  const auto wave = [](int pixel) {
    return 0.1 * std::sin(0.2 * (pixel % 40));
  };
  const ResidualStatistics by_estimate = Of(wave);
  Image render(problem_.image.width, problem_.image.height);
  for (size_t k = 0; k < L_o_.size(); ++k) {
    render.rgb[3 * problem_.points[k / 3].pixel + k % 3] =
        static_cast<float>(L_o_[k]);
  }
  const ResidualStatistics by_render =
      ResidualStatisticsOf(*ibrdf::SetUp(problem_), render);
  EXPECT_NEAR(by_estimate.misfit, by_render.misfit, 1e-5);
  EXPECT_NEAR(by_estimate.correlation, by_render.correlation, 1e-4);
}

TEST_F(ResidualStatisticsTest, OfWhatVariesSlowlyAndOfWhatAlternates) {
  const ResidualStatistics slow =
      Of([](int pixel) { return 0.1 * std::sin(0.2 * (pixel % 40)); });
  EXPECT_GT(slow.correlation, 0.9);
  EXPECT_LE(slow.correlation, 1.0);
  const ResidualStatistics fast =
      Of([](int pixel) { return pixel % 2 == 0 ? 0.1 : -0.1; });
  EXPECT_NEAR(0.1, fast.misfit, 1e-3);
  EXPECT_NEAR(-1.0, fast.correlation, 1e-3);
}

// A few pixels far off, as of glare, are not all that is said of the others.
TEST_F(ResidualStatisticsTest, OutliersAreLimited) {
  std::mt19937 rng(1);
  std::normal_distribution<double> noise(0.0, 0.05);
  const ResidualStatistics left = Of([&](int pixel) {
    return (pixel / 40) % 9 == 4 && pixel % 40 > 18 && pixel % 40 < 21
               ? 4.0
               : noise(rng);
  });
  EXPECT_LT(left.correlation, 0.4);
}

TEST_F(ResidualStatisticsTest, StrayLightIsPartOfTheEstimate) {
  estimate_.iterate.ambient = Eigen::Array3d::Constant(L_o_[0]);
  for (double& v : L_o_) v += estimate_.iterate.ambient[0];
  const ResidualStatistics left = Of([](int) { return 0.0; });
  EXPECT_LT(left.misfit, 1e-4);
}

// Three rows of 4000 pixels: a few thousand of them, neighbours in each row.
TEST_F(ResidualStatisticsTest, ALongObjectIsSampledInEachRow) {
  const std::vector<ShadingPoint> ball = problem_.points;
  problem_.image = Image(4000, 3);
  problem_.image.rgb.assign(problem_.image.rgb.size(), 1.0f);
  problem_.points.clear();
  for (int pixel = 0; pixel < 12000; ++pixel) {
    problem_.points.push_back(ball[pixel % ball.size()]);
    problem_.points.back().pixel = pixel;
  }
  const SolveSetup setup = *ibrdf::SetUp(problem_);
  const ResidualRows rows = ResidualRowsOf(setup, estimate_);
  EXPECT_LT(1000u, rows.indices.size());
  EXPECT_GT(4000u, rows.indices.size());
  std::set<int> of;
  for (const auto& [first, second] :
       PairsInRows(setup.pixels.points, rows.indices)) {
    of.insert(setup.pixels.points[rows.indices[first]].pixel / 4000);
  }
  EXPECT_EQ((std::set<int>{0, 1, 2}), of);
}

TEST_F(ResidualStatisticsTest, NoPixelsLeaveNothing) {
  problem_.points.clear();
  L_o_.clear();
  SolveSetup setup;
  setup.problem = &problem_;
  const ResidualStatistics left = ResidualStatisticsOf(setup, estimate_);
  EXPECT_EQ(0.0, left.misfit);
  EXPECT_EQ(0.0, left.correlation);
}

}  // namespace
}  // namespace ibrdf
