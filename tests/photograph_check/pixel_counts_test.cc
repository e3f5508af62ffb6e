#include "ibrdf/solvers/photograph_check/pixel_counts.h"

#include <gtest/gtest.h>

#include <limits>

namespace ibrdf {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(ObjectPixelCounts, EachPixelIsCountedOnceByItsWorstChannel) {
  Image image(3, 2);
  image.rgb = {1, 2, 3, 0, 1, 1, -1, 0, 1, kNan, -1, 0, 1, 1, 1, 0, 0, 0};
  std::vector<ShadingPoint> points(5);
  for (int i = 0; i < 5; ++i) points[static_cast<size_t>(i)].pixel = i;
  const ObjectPixelCounts floats = CountPixels(image, points, false);
  EXPECT_EQ(5u, floats.object);
  EXPECT_EQ(2u, floats.used);
  EXPECT_EQ(1u, floats.zero);
  EXPECT_EQ(1u, floats.negative);
  EXPECT_EQ(1u, floats.not_finite);
  EXPECT_EQ(0u, floats.clipped);
  const ObjectPixelCounts codes = CountPixels(image, points, true);
  EXPECT_EQ(0u, codes.not_finite);
  EXPECT_EQ(1u, codes.clipped);
}

TEST(ObjectPixelCounts, InfinityIsNoNumber) {
  const float rgb[3] = {1.0f, std::numeric_limits<float>::infinity(), 1.0f};
  EXPECT_EQ(PixelKind::kNotFinite, KindOfPixel(rgb, false));
}

}  // namespace
}  // namespace ibrdf
