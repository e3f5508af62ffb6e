#include "ibrdf/light/negative_radiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

Image Ones(int width, int height) {
  Image map(width, height);
  std::fill(map.rgb.begin(), map.rgb.end(), 1.0f);
  return map;
}

TEST(NegativeRadiance, IsClampedAndCounted) {
  Image map = Ones(32, 16);
  map.At(5, 3)[2] = -4e-6f;
  map.At(9, 7)[1] = -1e-8f;
  map.At(9, 7)[0] = -0.0f;
  const StatusOr<NegativeRadiance> found =
      ClampNegativeRadiance("a.exr", MapFrame::kCamera, &map);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(2, found->values);
  EXPECT_EQ(-4e-6f, found->lowest);
  // One texel of 512, smaller towards the pole, of a channel of ones.
  EXPECT_GT(found->share, 0.5 * 4e-6 / 512);
  EXPECT_LT(found->share, 2.0 * 4e-6 / 512);
  EXPECT_EQ(0.0f, map.At(5, 3)[2]);
  EXPECT_EQ(0.0f, map.At(9, 7)[1]);
  EXPECT_FALSE(std::signbit(map.At(9, 7)[0]));
  EXPECT_EQ(1.0f, map.At(9, 7)[2]);
}

TEST(NegativeRadiance, LeavesOtherMapsAlone) {
  Image map = Ones(32, 16);
  map.At(0, 0)[0] = 1e-42f;  // subnormal
  map.At(1, 0)[0] = std::numeric_limits<float>::max();
  const Image before = map;
  const StatusOr<NegativeRadiance> found =
      ClampNegativeRadiance("a.exr", MapFrame::kBlender, &map);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(0, found->values);
  EXPECT_EQ(0.0, found->share);
  EXPECT_EQ(before.rgb, map.rgb);
}

TEST(NegativeRadiance, RefusesWhatIsNotFinite) {
  for (const float value :
       {std::nanf(""), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    Image map = Ones(32, 16);
    map.At(7, 2)[1] = value;
    map.At(8, 2)[1] = -1e-9f;
    const StatusOr<NegativeRadiance> found =
        ClampNegativeRadiance("a.exr", MapFrame::kCamera, &map);
    ASSERT_FALSE(found.ok());
    EXPECT_EQ(0u, found.status().message().find(
                      "a.exr: row 2, column 7: expected finite radiance"))
        << found.status().message();
    EXPECT_EQ(-1e-9f, map.At(8, 2)[1]);
  }
}

TEST(NegativeRadiance, RefusesANoticeableShareOfTheLight) {
  Image map = Ones(32, 16);
  for (int c = 0; c < 32; ++c) map.At(c, 8)[1] = -1.0f;
  const StatusOr<NegativeRadiance> found =
      ClampNegativeRadiance("a.exr", MapFrame::kCamera, &map);
  ASSERT_FALSE(found.ok());
  // Row 8 of 16 is (cos 90 - cos 101.25 degrees) / 2 = 9.75 % of the sphere.
  EXPECT_NE(std::string::npos,
            found.status().message().find(
                "32 values below 0, the lowest -1, which hold 9.75"))
      << found.status().message();
  EXPECT_EQ(-1.0f, map.At(3, 8)[1]);
  // The same values at the pole are hardly any light.
  Image pole = Ones(512, 256);
  for (int c = 0; c < 512; ++c) pole.At(c, 0)[1] = -1.0f;
  EXPECT_TRUE(ClampNegativeRadiance("a.exr", MapFrame::kCamera, &pole).ok());
}

TEST(NegativeRadiance, IgnoresWhatIsNoPartOfTheMap) {
  Image cross = Ones(12, 16);
  cross.At(0, 0)[0] = std::nanf("");
  cross.At(11, 15)[1] = -5.0f;
  const StatusOr<NegativeRadiance> found =
      ClampNegativeRadiance("a.exr", MapFrame::kCubeCross, &cross);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(0, found->values);
  EXPECT_EQ(0.0f, cross.At(0, 0)[0]);
  EXPECT_EQ(0.0f, cross.At(11, 15)[1]);
  Image probe = Ones(16, 16);
  probe.At(0, 0)[0] = std::nanf("");
  EXPECT_TRUE(
      ClampNegativeRadiance("a.exr", MapFrame::kDebevecProbe, &probe).ok());
}

TEST(NegativeRadiance, RefusesSizesOfOtherFrames) {
  Image map = Ones(32, 15);
  EXPECT_FALSE(ClampNegativeRadiance("a.exr", MapFrame::kCamera, &map).ok());
}

TEST(NegativeRadiance, TakesABlackMap) {
  Image map(32, 16);
  EXPECT_TRUE(ClampNegativeRadiance("a.exr", MapFrame::kCamera, &map).ok());
}

}  // namespace
}  // namespace ibrdf
