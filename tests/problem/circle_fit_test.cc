#include "ibrdf/solvers/problem/circle_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ibrdf {
namespace {

Mask Disc(int width, int height, const PixelCircle& circle) {
  Mask mask(width, height, 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      mask.inside[static_cast<size_t>(y) * width + x] =
          std::hypot(x + 0.5 - circle.x, y + 0.5 - circle.y) < circle.radius;
    }
  }
  return mask;
}

void ExpectNear(const PixelCircle& expected, const PixelCircle& found,
                double tolerance) {
  EXPECT_NEAR(expected.x, found.x, tolerance);
  EXPECT_NEAR(expected.y, found.y, tolerance);
  EXPECT_NEAR(expected.radius, found.radius, tolerance);
}

TEST(CircleFit, FindsDiscsOfAnySizeAndPlace) {
  for (const PixelCircle& circle :
       {PixelCircle{150.3, 210.8, 90.4}, PixelCircle{40.0, 40.5, 12.25},
        PixelCircle{200.2, 33.3, 30.0}}) {
    const auto fit = FitCircle(Disc(300, 400, circle));
    ASSERT_TRUE(fit.has_value());
    ExpectNear(circle, fit->circle, 0.15);
    EXPECT_LT(fit->residual, 0.5);
    EXPECT_GT(fit->overlap, 0.98);
  }
}

TEST(CircleFit, ADiscThatTheImageCutsOffIsWhole) {
  const PixelCircle circle = {20.0, 95.0, 60.0};
  const auto fit = FitCircle(Disc(120, 120, circle));
  ASSERT_TRUE(fit.has_value());
  ExpectNear(circle, fit->circle, 0.5);
}

TEST(CircleFit, BitesHolesAndSpecksDoNotMoveIt) {
  const PixelCircle circle = {70.5, 60.0, 45.0};
  Mask mask = Disc(150, 130, circle);
  const auto set = [&](int x0, int y0, int x1, int y1, int value) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        mask.inside[static_cast<size_t>(y) * mask.width + x] =
            static_cast<uint8_t>(value);
      }
    }
  };
  set(50, 40, 65, 50, 0);    // a highlight
  set(60, 90, 85, 130, 0);   // a stand
  set(130, 10, 140, 20, 1);  // another object
  const auto fit = FitCircle(mask);
  ASSERT_TRUE(fit.has_value());
  ExpectNear(circle, fit->circle, 0.3);
}

TEST(CircleFit, TellsHowFarTheMaskIsFromACircle) {
  Mask mask(100, 60, 0);
  for (int y = 15; y < 45; ++y) {
    for (int x = 10; x < 90; ++x) mask.inside[y * 100 + x] = 1;
  }
  const auto fit = FitCircle(mask);
  EXPECT_TRUE(!fit.has_value() || fit->overlap < 0.7);
}

TEST(CircleFit, NothingToFit) {
  EXPECT_FALSE(FitCircle(Mask(30, 20, 1)).has_value());
  EXPECT_FALSE(FitCircle(Mask(30, 20, 0)).has_value());
  Mask one(30, 20, 0);
  one.inside[70] = 1;
  EXPECT_FALSE(FitCircle(one).has_value());
  Mask half(30, 20, 0);  // a straight boundary
  for (size_t i = 0; i < half.inside.size(); ++i) half.inside[i] = i % 30 < 15;
  const auto fit = FitCircle(half);
  EXPECT_TRUE(!fit.has_value() || std::isfinite(fit->circle.radius));
}

TEST(CircleFit, OverlapIsIntersectionOverUnion) {
  const PixelCircle circle = {10, 10, 5};
  const Mask disc = Disc(20, 20, circle);
  EXPECT_EQ(1.0, CircleOverlap(disc, circle));
  const double all = static_cast<double>(disc.CountInside()) / 400;
  EXPECT_DOUBLE_EQ(all, CircleOverlap(Mask(20, 20, 1), circle));
  EXPECT_EQ(0.0, CircleOverlap(disc, {-20, 10, 5}));
}

}  // namespace
}  // namespace ibrdf
