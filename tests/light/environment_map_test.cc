#include "ibrdf/light/environment_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"
#include "tests/light/rounding.h"

namespace ibrdf {
namespace {

Image Smooth(int height, int width) {
  Image map(width, height);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const Eigen::Vector3d d = MapDirection(r + 0.5, c + 0.5, height, width);
      map.At(c, r)[0] = static_cast<float>(1.0 + 0.5 * d.x());
      map.At(c, r)[1] = static_cast<float>(d.y() * d.y());
      map.At(c, r)[2] = static_cast<float>(std::exp(d.z()));
    }
  }
  return map;
}

TEST(EnvironmentMap, FollowsTheDirectionConvention) {
  // Row 0 is up; column 0 starts at +z and turns to +x.
  EXPECT_TRUE(MapDirection(0, 0, 8, 16).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(MapDirection(4, 0, 8, 16).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(MapDirection(4, 4, 8, 16).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(MapDirection(4, 12, 8, 16).isApprox(-Eigen::Vector3d::UnitX()));
}

TEST(EnvironmentMap, PositionInvertsDirection) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double row = 64 * u(rng), column = 128 * u(rng);
    double r = 0.0, c = 0.0;
    MapPosition(3.0 * MapDirection(row, column, 64, 128), 64, 128, &r, &c);
    EXPECT_NEAR(row, r, 64 * kRounding);
    EXPECT_NEAR(column, c, 1e-8);  // 1 / sin(theta) beside the poles
  }
}

TEST(EnvironmentMap, FastPositionIsThePosition) {
  std::mt19937 rng(7);
  std::normal_distribution<double> gauss;
  std::vector<Eigen::Vector3d> directions = {
      {0, 1, 0},       {0, -1, 0},       {0, 0, 1},         {0, 0, -1},
      {-1e-320, 0, 1}, {1e-9, 1, -1e-9}, {-1e-17, 0.5, 1.0}};
  for (int i = 0; i < 2000; ++i) {
    directions.push_back({gauss(rng), gauss(rng), gauss(rng)});
  }
  for (const Eigen::Vector3d& d : directions) {
    double row = 0.0, column = 0.0, r = -1.0, c = -1.0;
    MapPosition(d, 64, 128, &row, &column);
    FastMapPosition(d, 64, 128, &r, &c);
    EXPECT_NEAR(row, r, 64 * 2e-9) << d.transpose();
    // The seam's two sides are one place.
    EXPECT_NEAR(0.0, std::remainder(column - c, 128), 128 * 2e-9)
        << d.transpose();
    EXPECT_GE(c, 0.0);
    EXPECT_LT(c, 128.0);
  }
}

TEST(EnvironmentMap, PositionStaysInRangeAtPolesAndSeam) {
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -1, 0),
        Eigen::Vector3d(-1e-320, 0, 1), Eigen::Vector3d(-0.0, 0.0, 1.0),
        Eigen::Vector3d(-1e-17, 0.5, 1.0)}) {
    double r = -1.0, c = -1.0;
    MapPosition(d, 7, 10, &r, &c);
    EXPECT_GE(r, 0.0);
    EXPECT_LE(r, 7.0);
    EXPECT_GE(c, 0.0);
    EXPECT_LT(c, 10.0);
  }
}

TEST(EnvironmentMap, SolidAnglesAddToTheSphere) {
  for (const int height : {1, 2, 7, 64, 1024}) {
    double sum = 0.0;
    for (int r = 0; r < height; ++r) {
      sum += 2 * height * TexelSolidAngle(r, height, 2 * height);
    }
    EXPECT_NEAR(4 * kPi, sum, 1e-11);
  }
}

TEST(EnvironmentMap, TapsArePositiveWeightsThatSumToOneAndHitCentres) {
  std::mt19937 rng(2);
  std::normal_distribution<double> g;
  for (int i = 0; i < 2000; ++i) {
    const MapTaps taps =
        BilinearTaps(Eigen::Vector3d(g(rng), g(rng), g(rng)), 16, 32);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(taps.weight[k], 0.0);
      EXPECT_GE(taps.texel[k], 0);
      EXPECT_LT(taps.texel[k], 16 * 32);
      sum += taps.weight[k];
    }
    EXPECT_NEAR(1.0, sum, kRounding);
  }
  const Image map = Smooth(16, 32);
  for (int r = 0; r < 16; ++r) {
    for (int c = 0; c < 32; ++c) {
      const Eigen::Array3d L =
          LookUpMap(map, MapDirection(r + 0.5, c + 0.5, 16, 32));
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(map.At(c, r)[k], L[k], 1e-9);
    }
  }
}

TEST(EnvironmentMap, LookupIsContinuousOverThePolesAndTheSeam) {
  const Image map = Smooth(16, 32);
  // Steps of 1e-6 across a pole and across column 0: a jump would be of the
  // order of neighbouring texels' difference, 0.1.
  for (const double sign : {1.0, -1.0}) {
    for (double phi = 0.0; phi < kPi; phi += 0.37) {
      const Eigen::Vector3d step(1e-6 * std::sin(phi), 0, 1e-6 * std::cos(phi));
      const Eigen::Vector3d pole(0, sign, 0);
      EXPECT_LT((LookUpMap(map, pole + step) - LookUpMap(map, pole - step))
                    .abs()
                    .maxCoeff(),
                1e-4);
    }
  }
  EXPECT_LT((LookUpMap(map, {1e-7, 0.3, 1}) - LookUpMap(map, {-1e-7, 0.3, 1}))
                .abs()
                .maxCoeff(),
            1e-5);
}

TEST(EnvironmentMap, MeanRadianceMatchesClosedForm) {
  // Means over the sphere of 1 + x/2, y^2, exp(z); midpoint rule, error
  // O(1 / H^2).
  const Eigen::Array3d mean = MeanRadiance(Smooth(128, 256));
  EXPECT_NEAR(1.0, mean[0], 1e-4);
  EXPECT_NEAR(1.0 / 3.0, mean[1], 1e-4);
  EXPECT_NEAR(std::sinh(1.0), mean[2], 1e-4);
}

TEST(EnvironmentMap, ResizeKeepsMeanAndConstants) {
  const Image map = Smooth(24, 48);
  const Eigen::Array3d mean = MeanRadiance(map);
  for (const auto& [h, w] :
       {std::pair{12, 24}, {8, 16}, {7, 10}, {64, 128}, {24, 48}, {1, 2}}) {
    const Eigen::Array3d resized = MeanRadiance(ResizeMap(map, h, w));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(mean[k], resized[k], kFloatRounding) << h << " x " << w;
    }
    Image constant(48, 24);
    for (float& v : constant.rgb) v = 0.7f;
    for (const float v : ResizeMap(constant, h, w).rgb) {
      EXPECT_NEAR(0.7f, v, kFloatRounding);
    }
  }
  const Image same = ResizeMap(map, 24, 48);
  for (size_t i = 0; i < map.rgb.size(); ++i) {
    EXPECT_NEAR(map.rgb[i], same.rgb[i], kFloatRounding);
  }
}

// Larger, smaller and the same.
TEST(EnvironmentMap, ResampledPlanesAreTheLookUpAtTheCentres) {
  const Image map = Smooth(8, 16);
  const size_t texels = map.num_pixels();
  std::vector<float> planes(3 * texels);
  for (size_t i = 0; i < planes.size(); ++i) {
    planes[i % 3 * texels + i / 3] = map.rgb[i];
  }
  for (const MapSize to : {MapSize{34, 17}, MapSize{6, 3}, MapSize{16, 8}}) {
    const std::vector<float> out = ResamplePlanes(planes, {16, 8}, to);
    const int count = to.width * to.height;
    ASSERT_EQ(size_t{3} * count, out.size());
    for (int t = 0; t < count; ++t) {
      const Eigen::Array3d value =
          LookUpMap(map, MapDirection(t / to.width + 0.5, t % to.width + 0.5,
                                      to.height, to.width));
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(static_cast<float>(value[c]), out[c * count + t]);
      }
    }
  }
}

TEST(EnvironmentMap, ResizeWeighsRowsBySolidAngle) {
  Image map(2, 4);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 2; ++c) map.At(c, r)[0] = static_cast<float>(r);
  }
  const Image half = ResizeMap(map, 2, 2);
  const double a = TexelSolidAngle(0, 4, 2), b = TexelSolidAngle(1, 4, 2);
  EXPECT_NEAR(b / (a + b), half.At(0, 0)[0], kFloatRounding);
  EXPECT_NEAR((2 * b + 3 * a) / (a + b), half.At(1, 1)[0], kFloatRounding);
}

}  // namespace
}  // namespace ibrdf
