#include "ibrdf/solvers/observation/observation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ibrdf/solvers/observation/mean_by_normal.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kSize = 72;    // pixels a side
constexpr int kAcross = 24;  // 3x3 pixels to a bin
constexpr double kMinCosine = 0.1;

// Of radiance that is another in every pixel; one of them is black.
InverseProblem SphereProblem() {
  InverseProblem problem;
  problem.points = SpherePoints(kSize);
  problem.image = Image(kSize, kSize);
  for (size_t i = 0; i < problem.image.rgb.size(); ++i) {
    problem.image.rgb[i] = static_cast<float>(std::exp(std::sin(7.0 * i)));
  }
  problem.image.rgb[size_t{3} * (kSize / 2 * kSize + kSize / 2)] = 0.0f;
  return problem;
}

TEST(LevelPair, IsANinthOfTheImageAndItsCells) {
  const InverseProblem problem = SphereProblem();
  const LevelPair pair = MakeLevelPair(problem, kAcross);
  const double share =
      static_cast<double>(pair.pixels->points.size()) / problem.points.size();
  EXPECT_NEAR(1.0 / 9.0, share, 0.02);
  std::set<int> blocks;
  for (const ShadingPoint& p : pair.pixels->points) {
    blocks.insert(p.pixel / kSize / 8 * 100 + p.pixel % kSize / 8);
  }
  EXPECT_GE(blocks.size(), 8u);  // of nine, corners may miss the sphere
  const BinMeans bins = MeanByNormal(
      pair.pixels->points, RadianceOf(problem.image, pair.pixels->points),
      kAcross, kMinCosine);
  ASSERT_EQ(bins.points.size(), pair.bins->points.size());
  EXPECT_LT(3 * bins.points.size(), pair.pixels->points.size());
  EXPECT_EQ(bins.radiance, pair.bins->observed.radiance);
}

// All pixels of the pair are transported at once.
TEST(LevelPair, OfALargeImageIsThinner) {
  InverseProblem problem;
  problem.points = SpherePoints(700);
  problem.image = Image(700, 700);
  std::fill(problem.image.rgb.begin(), problem.image.rgb.end(), 1.0f);
  ASSERT_GT(problem.points.size() / 9, 40000u);
  const LevelPair pair = MakeLevelPair(problem, kAcross);
  EXPECT_LT(pair.pixels->points.size(), 9000u);
  EXPECT_GT(pair.pixels->points.size(), 4000u);
  EXPECT_GT(pair.bins->points.size(), 300u);
}

TEST(BinningError, IsTheMeanDifferenceOfLogarithms) {
  const InverseProblem problem = SphereProblem();
  const LevelPair pair = MakeLevelPair(problem, kAcross);
  const std::vector<double> of_pixels =
      RadianceOf(problem.image, pair.pixels->points);
  std::vector<double> of_bins = pair.bins->observed.radiance;
  const auto error = [&](const std::vector<double>& pixels,
                         const std::vector<double>& bins) {
    return BinningError(*pair.pixels, pixels, bins, kAcross);
  };
  EXPECT_LT(error(of_pixels, of_bins), 1e-12);
  for (size_t i = 0; i < of_bins.size(); ++i) {
    of_bins[i] *= std::exp(i % 3 == 0 ? 0.3 : i % 3 == 1 ? -0.3 : 0.0);
  }
  EXPECT_NEAR(0.2, error(of_pixels, of_bins), 1e-12);
  // A model that is black where the image is not.
  EXPECT_EQ(0.0, error(std::vector<double>(of_pixels.size(), 0.0), of_bins));
  of_bins[0] = 0.0;
  EXPECT_EQ(0.0, error(of_pixels, of_bins));
}

}  // namespace
}  // namespace ibrdf
