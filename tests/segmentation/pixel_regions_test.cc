#include "ibrdf/solvers/segmentation/pixel_regions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "labelled_ball.h"

namespace ibrdf {
namespace {

TEST(GatherPixels, BlocksAreMeansAndTheLimbHasNoPart) {
  const LabelledBall ball =
      MakeLabelledBall(40, 0.0, [](int, int) { return 0; });
  const MaterialPixels full =
      GatherPixels(ball.points, ball.Observed(), ball.width, 1);
  const MaterialPixels half =
      GatherPixels(ball.points, ball.Observed(), ball.width, 2);
  EXPECT_LT(full.count(), static_cast<int>(ball.points.size()));
  EXPECT_NEAR(full.count() / 4.0, half.count(), 0.1 * half.count());
  for (size_t i = 0; i < ball.points.size(); ++i) {
    const ShadingPoint& p = ball.points[i];
    EXPECT_EQ(p.normal.z() >= 0.2f, full.pixel_of_point[i] >= 0);
  }
  // The luminance of a block of four.
  const int pixel = half.pixel_of_point[ball.points.size() / 2];
  double sum = 0.0;
  for (size_t i = 0; i < ball.points.size(); ++i) {
    if (half.pixel_of_point[i] != pixel) continue;
    for (int c = 0; c < 3; ++c) {
      sum += std::log(ball.radiance[3 * i + c]) / (4.0 * std::sqrt(3.0));
    }
  }
  EXPECT_NEAR(sum, half.colours(pixel, 0), 1e-9);
  EXPECT_NEAR(1.0, half.normals.row(pixel).norm(), 1e-9);
}

TEST(GatherPixels, WhatIsNotValidTakesNoPart) {
  LabelledBall ball = MakeLabelledBall(20, 0.0, [](int, int) { return 0; });
  const size_t middle = ball.points.size() / 2;
  ball.radiance[3 * middle + 1] = 0.0;
  const MaterialPixels pixels =
      GatherPixels(ball.points, ball.Observed(), ball.width, 1);
  EXPECT_EQ(-1, pixels.pixel_of_point[middle]);
  EXPECT_TRUE(pixels.colours.allFinite());
  EXPECT_TRUE(pixels.smooth.allFinite());
}

TEST(FindRegions, ArePartedBySharpSteps) {
  const LabelledBall ball =
      MakeLabelledBall(48, 0.01, [](int x, int) { return x < 24 ? 0 : 1; });
  const MaterialPixels pixels =
      GatherPixels(ball.points, ball.Observed(), ball.width, 1);
  const std::vector<int> region = FindRegions(pixels, 0.12);
  EXPECT_EQ(1, *std::max_element(region.begin(), region.end()));
  for (size_t i = 0; i < ball.points.size(); ++i) {
    const int pixel = pixels.pixel_of_point[i];
    if (pixel < 0) continue;
    const int first = ball.labels[i] == ball.labels[0] ? 0 : 1;
    EXPECT_EQ(first, region[pixel]);
  }
  // Steps of that size are none.
  const std::vector<int> whole = FindRegions(pixels, 2.0);
  EXPECT_EQ(0, *std::max_element(whole.begin(), whole.end()));
}

}  // namespace
}  // namespace ibrdf
