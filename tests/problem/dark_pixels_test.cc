#include "ibrdf/solvers/problem/dark_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr int kSphereSize = 48;  // pixels a side

// The pixels of a unit sphere, seen along -z.
std::vector<ShadingPoint> SpherePixels() {
  std::vector<ShadingPoint> points;
  for (int y = 0; y < kSphereSize; ++y) {
    for (int x = 0; x < kSphereSize; ++x) {
      const double X = (x + 0.5) / kSphereSize * 2 - 1,
                   Y = 1 - (y + 0.5) / kSphereSize * 2;
      const double square = X * X + Y * Y;
      if (square > 0.98) continue;
      ShadingPoint p;
      p.normal = Eigen::Vector3d(X, Y, std::sqrt(1 - square)).cast<float>();
      p.wo = Eigen::Vector3f::UnitZ();
      p.pixel = y * kSphereSize + x;
      p.coverage = 1.0f;
      p.index = static_cast<int>(points.size());
      points.push_back(p);
    }
  }
  return points;
}

// A map of one radiance and one texel brighter.
Image LampMap(int row, int column, float rest) {
  Image map(128, 64);
  map.rgb.assign(map.rgb.size(), rest);
  for (int c = 0; c < 3; ++c) map.rgb[3 * (row * 128 + column) + c] = 1e3f;
  return map;
}

size_t Count(const std::vector<Lighting>& lighting, Lighting which) {
  return static_cast<size_t>(
      std::count(lighting.begin(), lighting.end(), which));
}

TEST(FindLighting, FollowsTheCosineOfALamp) {
  const std::vector<ShadingPoint> points = SpherePixels();
  const Image map = LampMap(20, 20, 0.0f);
  const Eigen::Vector3d lamp = MapDirection(20.5, 20.5, 64, 128);
  const std::vector<Lighting> lighting = FindLighting(points, map, {});
  const double texel = kPi / 64;
  for (size_t i = 0; i < points.size(); ++i) {
    const double cosine = points[i].normal.cast<double>().dot(lamp);
    if (cosine > 1.1 * texel) {
      EXPECT_EQ(Lighting::kLit, lighting[i]) << cosine;
    }
    if (cosine < 0.8 * texel) {
      EXPECT_NE(Lighting::kLit, lighting[i]) << cosine;
    }
    if (cosine < -1.1 * texel) {
      EXPECT_EQ(Lighting::kNone, lighting[i]) << cosine;
    }
  }
  EXPECT_GT(Count(lighting, Lighting::kPenumbra), size_t{10});
  EXPECT_GT(Count(lighting, Lighting::kNone), size_t{100});
}

TEST(FindLighting, LeavesNothingDarkUnderASky) {
  const std::vector<ShadingPoint> points = SpherePixels();
  // Its irradiance is 0.02 of the lamp's.
  for (const float sky : {0.015f, 1.0f}) {
    const std::vector<Lighting> lighting =
        FindLighting(points, LampMap(20, 20, sky), {});
    EXPECT_EQ(points.size(), Count(lighting, Lighting::kLit)) << sky;
  }
}

TEST(FindLighting, OfALampBehindTheObjectIsNone) {
  const std::vector<ShadingPoint> points = SpherePixels();
  // The library's frame: column 0 is +z, the middle -z.
  const std::vector<Lighting> lighting =
      FindLighting(points, LampMap(32, 64, 0.0f), {});
  EXPECT_EQ(size_t{0}, Count(lighting, Lighting::kLit));
}

class StrayLightTest : public ::testing::Test {
 protected:
  StrayLightTest()
      : points_(SpherePixels()),
        lighting_(points_.size(), Lighting::kLit),
        image_(kSphereSize, kSphereSize) {
    image_.rgb.assign(image_.rgb.size(), 1.0f);
  }
  // Darkens `count` points; their radiance is about 0.1, 0.2, 0.3.
  void Darken(size_t count) {
    for (size_t i = 0; i < count; ++i) {
      lighting_[i] = Lighting::kNone;
      for (int c = 0; c < 3; ++c) {
        image_.rgb[3 * points_[i].pixel + c] = static_cast<float>(
            0.1 * (c + 1) * (1 + 0.02 * (static_cast<double>(i % 5) - 2)));
      }
    }
  }
  StrayLight Measure() const {
    return MeasureStrayLight(image_, points_, lighting_);
  }

  const std::vector<ShadingPoint> points_;
  std::vector<Lighting> lighting_;
  Image image_;
};

TEST_F(StrayLightTest, IsTheMedianOfThePointsWithoutLight) {
  Darken(200);
  // A reflection, a defect and a pixel that is no number.
  image_.rgb[3 * points_[3].pixel] = 1e6f;
  image_.rgb[3 * points_[8].pixel] = -5.0f;
  image_.rgb[3 * points_[13].pixel] = std::numeric_limits<float>::quiet_NaN();
  const StrayLight stray = Measure();
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(0.1 * (c + 1), stray.ambient[c], 1e-6);
    EXPECT_NEAR(1.4826 * 0.02 * stray.ambient[c], stray.spread[c], 1e-6);
    // It differs by a tenth over the object, whatever the shadow shows.
    EXPECT_NEAR(0.1 * stray.ambient[c], stray.deviation[c], 1e-6);
  }
}

TEST_F(StrayLightTest, IsNoneOfFewOrBlackOrNegativePoints) {
  EXPECT_FALSE((Measure().deviation > 0.0).any());
  Darken(7);
  EXPECT_FALSE((Measure().deviation > 0.0).any());
  Darken(50);
  EXPECT_TRUE((Measure().deviation > 0.0).all());
  for (const float v : {0.0f, -0.01f}) {
    image_.rgb.assign(image_.rgb.size(), v);
    EXPECT_FALSE((Measure().deviation > 0.0).any());
    EXPECT_TRUE((Measure().ambient == 0.0).all());
  }
}

TEST_F(StrayLightTest, IsNoneWhereNoCameraTellsItFromBlack) {
  Darken(50);
  for (const float radiance : {1e-27f, 0.9e-6f, 1.1e-6f}) {
    for (size_t i = 0; i < 150; ++i) {
      image_.rgb[3 * points_[i / 3].pixel + i % 3] = radiance;
    }
    EXPECT_EQ(radiance > 1e-6f, (Measure().ambient > 0.0).all()) << radiance;
  }
}

TEST_F(StrayLightTest, OfOneChannelHasADeviationInAll) {
  Darken(50);
  for (size_t i = 0; i < 50; ++i) image_.rgb[3 * points_[i].pixel] = 0.0f;
  const StrayLight stray = Measure();
  EXPECT_EQ(0.0, stray.ambient[0]);
  EXPECT_TRUE((stray.deviation > 0.0).all());
}

TEST_F(StrayLightTest, HidesLightWithinItsSpread) {
  Darken(200);
  const StrayLight stray = Measure();
  EXPECT_TRUE(IsBelowFloor(stray.ambient, stray));
  EXPECT_TRUE(IsBelowFloor(stray.ambient + 2.9 * stray.spread, stray));
  EXPECT_FALSE(IsBelowFloor(stray.ambient + 3.1 * stray.spread, stray));
  // One channel that shows the light is enough.
  EXPECT_FALSE(
      IsBelowFloor({0.0, 0.0, stray.ambient[2] + 4 * stray.spread[2]}, stray));
  EXPECT_FALSE(IsBelowFloor({1e-9, 1e-9, 1e-9}, StrayLight()));
}

}  // namespace
}  // namespace ibrdf
