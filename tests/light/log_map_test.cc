#include "ibrdf/light/log_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace ibrdf {
namespace {

constexpr MapSize kSize = {8, 4};

LogMap Random(MapSize size, unsigned seed, float spread = 1.0f) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> g;
  std::vector<float> values(3 * size.num_texels());
  for (float& v : values) v = spread * g(rng);
  return {size, values};
}

TEST(LogMap, PlanesBecomePixelsWithoutOverflow) {
  const LogMap log_map({2, 1}, {0, 1, -1000, 2, 1000, 3});
  std::vector<float> map;
  log_map.Exp(&map);
  ASSERT_EQ(6u, map.size());
  EXPECT_FLOAT_EQ(1.0f, map[0]);
  EXPECT_GT(map[1], 0.0f);
  EXPECT_LT(map[1], 1e-20f);
  EXPECT_GT(map[2], 1e20f);
  EXPECT_TRUE(std::isfinite(map[2]));
  EXPECT_FLOAT_EQ(std::exp(1.0f), map[3]);
  EXPECT_FLOAT_EQ(std::exp(2.0f), map[4]);
  EXPECT_FLOAT_EQ(std::exp(3.0f), map[5]);
  // Slopes are the values but where those are clamped.
  std::vector<float> again, slopes;
  log_map.Exp(&again, &slopes);
  EXPECT_EQ(map, again);
  map[1] = map[2] = 0.0f;
  EXPECT_EQ(map, slopes);
}

TEST(LogMap, PlanesAreRowsAndColumnsOfTheirChannel) {
  LogMap map(kSize);
  EXPECT_EQ(std::vector<float>(3 * 32, 0.0f), map.values());
  map.Plane(2)(3, 5) = 7.0f;
  EXPECT_EQ(7.0f, map.values()[2 * 32 + 3 * 8 + 5]);
  EXPECT_EQ(7.0f, static_cast<const LogMap&>(map).Plane(2).sum());
  map.Reshape({2, 1});
  EXPECT_EQ(6u, map.values().size());
  EXPECT_EQ(2, map.Plane(1).cols());
}

TEST(LogMap, ExpAndFromPlanesInvertTheLogarithmOfAnImage) {
  const LogMap log_map = Random(kSize, 1);
  std::vector<float> map;
  log_map.Exp(&map);
  std::vector<float> logs(map.size());
  for (size_t i = 0; i < map.size(); ++i) logs[i] = std::log(map[i]);
  const Image back = FromPlanes(log_map.values(), kSize.width, kSize.height);
  ASSERT_EQ(logs.size(), back.rgb.size());
  for (size_t i = 0; i < logs.size(); ++i) {
    // One rounding of exp, one of log.
    EXPECT_NEAR(back.rgb[i], logs[i], 2e-7 * (1 + std::abs(back.rgb[i])));
  }
}

// Values on both sides of the clamp: their products with a direction, against
// central differences of Exp, and as each other's transposes.
class LogMapExpTest : public ::testing::TestWithParam<float> {
 protected:
  LogMapExpTest() : log_map_(Random(kSize, 2)), d_log_(Random(kSize, 3)) {
    for (int c = 0; c < 3; ++c) {
      log_map_.Plane(c).array() += (c - 1) * GetParam();
    }
    log_map_.Exp(&map_, &slopes_);
  }

  LogMap log_map_;
  const LogMap d_log_;
  std::vector<float> map_, slopes_;
};

TEST_P(LogMapExpTest, JvpMatchesDifferences) {
  std::vector<float> d_map;
  ExpJvp(slopes_, d_log_, &d_map);
  constexpr float kStep = 1.0f / 256;
  const auto at = [&](float t) {
    LogMap moved = log_map_;
    for (int c = 0; c < 3; ++c) moved.Plane(c) += t * d_log_.Plane(c);
    std::vector<float> map;
    moved.Exp(&map);
    return map;
  };
  const std::vector<float> up = at(kStep), down = at(-kStep);
  int clamped = 0, free = 0;
  for (size_t i = 0; i < map_.size(); ++i) {
    const size_t plane = i % 3 * kSize.num_texels() + i / 3;
    const float l = log_map_.values()[plane], v = d_log_.values()[plane];
    // The kink lies between.
    if (std::abs(std::abs(l) - kMaxLogRadiance) < kStep * std::abs(v)) continue;
    (std::abs(l) < kMaxLogRadiance ? free : clamped) += 1;
    const double numeric = (double{up[i]} - down[i]) / (2 * double{kStep});
    // Floats l of size up to 62 round by 2e-6, which a difference over 2 / 256
    // shows as 1e-3.
    EXPECT_NEAR(numeric, d_map[i], 2e-3 * map_[i]) << l;
  }
  EXPECT_GT(free, 20);
  EXPECT_EQ(GetParam() > kMaxLogRadiance - 3, clamped > 20);
}

TEST_P(LogMapExpTest, VjpIsTheTransposeAndIsAdded) {
  std::vector<float> d_map, by_map = map_;
  ExpJvp(slopes_, d_log_, &d_map);
  std::mt19937 rng(4);
  std::normal_distribution<float> g;
  for (size_t i = 0; i < map_.size(); ++i) by_map[i] = g(rng) / map_[i];
  LogMap by_log(kSize), twice(kSize);
  AddExpVjp(slopes_, by_map, &by_log);
  double forward = 0.0, reverse = 0.0, size = 0.0;
  for (size_t i = 0; i < map_.size(); ++i) {
    forward += double{by_map[i]} * d_map[i];
    reverse += double{by_log.values()[i]} * d_log_.values()[i];
    size += std::abs(double{by_map[i]} * d_map[i]);
  }
  EXPECT_NEAR(forward, reverse, 3e-7 * size);  // roundings of floats
  EXPECT_GT(size, 1.0);
  AddExpVjp(slopes_, by_map, &twice);
  AddExpVjp(slopes_, by_map, &twice);
  for (size_t i = 0; i < map_.size(); ++i) {
    EXPECT_EQ(2.0f * by_log.values()[i], twice.values()[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, LogMapExpTest,
                         ::testing::Values(0.0f, 20.0f, kMaxLogRadiance,
                                           kMaxLogRadiance + 10.0f));

TEST(LogMap, ResizedIsResamplePlanesAndKeepsConstants) {
  const LogMap map = Random(kSize, 5);
  for (const MapSize to : {MapSize{16, 8}, MapSize{6, 3}, kSize}) {
    const LogMap resized = map.Resized(to);
    EXPECT_TRUE(to == resized.size());
    EXPECT_EQ(ResamplePlanes(map.values(), kSize, to), resized.values());
  }
  const LogMap same = map.Resized(kSize);
  LogMap constant(kSize);
  for (int c = 0; c < 3; ++c) constant.Plane(c).setConstant(c - 1.5f);
  const LogMap larger = constant.Resized({22, 11});
  for (int c = 0; c < 3; ++c) {
    // Weights of the taps sum to 1 within roundings.
    EXPECT_NEAR(c - 1.5f, larger.Plane(c).minCoeff(), 1e-6);
    EXPECT_NEAR(c - 1.5f, larger.Plane(c).maxCoeff(), 1e-6);
    // Between texels' centres at the same size: the texels themselves.
    EXPECT_TRUE(same.Plane(c).isApprox(map.Plane(c), 1e-6f));
  }
}

TEST(LogMap, MeanIsThatOfTheSphere) {
  LogMap map({32, 16});
  for (int r = 0; r < 16; ++r) {
    for (int x = 0; x < 32; ++x) {
      const Eigen::Vector3d d = MapDirection(r + 0.5, x + 0.5, 16, 32);
      map.Plane(0)(r, x) = 0.75f;
      map.Plane(1)(r, x) = static_cast<float>(d.y());
      map.Plane(2)(r, x) = static_cast<float>(d.y() * d.y());
    }
  }
  const Eigen::Array3d mean = map.Mean();
  EXPECT_NEAR(0.75, mean[0], 1e-6);
  EXPECT_NEAR(0.0, mean[1], 1e-6);
  // The midpoint of rows of height pi / 16 is off by some (pi / 16)^2 / 12.
  EXPECT_NEAR(1.0 / 3.0, mean[2], 4e-3);
  // That of radiance, as MeanRadiance weighs it.
  const Eigen::Array3d of_image =
      MeanRadiance(FromPlanes(map.values(), 32, 16));
  EXPECT_TRUE(mean.isApprox(of_image, 1e-6));
}

TEST(RelativeMap, IsThePixelsOverTheLargest) {
  const double planes[6] = {900.0, 901.0, 899.0, 902.0, -1000.0, 900.0};
  const std::vector<float> map = RelativeMap(planes, 2);
  const std::vector<double> expected = {-2.0, -3.0, -1902.0, -1.0, 0.0, -2.0};
  ASSERT_EQ(expected.size(), map.size());
  for (size_t i = 0; i < map.size(); ++i) {
    EXPECT_FLOAT_EQ(static_cast<float>(std::exp(expected[i])), map[i]);
  }
}

}  // namespace
}  // namespace ibrdf
