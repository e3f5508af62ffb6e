#include "ibrdf/solvers/photograph_check/like_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/photograph_check/surfaces.h"

namespace ibrdf {
namespace {

// A smooth function of the normal, as of a matte material under smooth light.
Eigen::Array3d Matte(const Eigen::Vector3d& n) {
  return Eigen::Array3d(0.8, 0.5, 0.3) *
         (1.2 + n.x() + Eigen::Array3d(0.1, 0.2, 0.5) * n.y());
}

LikeNormalsSpread SpreadOf(const Image& normals, const Image& image) {
  const std::vector<ShadingPoint> points = PointsOf(normals);
  return SpreadOfLikeNormals(SampleNormals(image, points), points);
}

TEST(LikeNormals, AFunctionOfTheNormalHasHardlyASpread) {
  const Image normals = SurfaceNormals(96, Bumps);
  const LikeNormalsSpread spread =
      SpreadOf(normals, Painted(normals, [](const Eigen::Vector3d& n, int,
                                            int) { return Matte(n); }));
  EXPECT_GT(spread.share, 0.9);
  EXPECT_LT(spread.log_radiance, 1e-3);
  EXPECT_LT(spread.log_colour, 1e-3);
}

TEST(LikeNormals, NoiseIsMeasuredAsItsMeanAbsoluteDeviation) {
  const Image normals = SurfaceNormals(128, Bumps);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  const LikeNormalsSpread spread = SpreadOf(
      normals, Painted(normals, [&](const Eigen::Vector3d& n, int, int) {
        const Eigen::Array3d e(noise(random), noise(random), noise(random));
        return Eigen::Array3d(Matte(n) * e.exp());
      }));
  // E|x| of a normal deviate is 0.798 of its deviation; a difference of two
  // channels has sqrt(2) of it. Of 16384 pixels the mean is off by 0.5 %.
  EXPECT_NEAR(0.0399, spread.log_radiance, 0.001);
  EXPECT_NEAR(0.0564, spread.log_colour, 0.0015);
  EXPECT_NEAR(spread.share * spread.log_radiance, spread.Floor(), 1e-12);
}

TEST(LikeNormals, ASphereHasNoOtherPlaces) {
  const Image normals = SphereNormals(128);
  // As sharp as a reflection of a checkered room.
  const LikeNormalsSpread spread = SpreadOf(
      normals, Painted(normals, [](const Eigen::Vector3d&, int x, int y) {
        const double L = (x / 3 + y / 3) % 2 == 0 ? 1.0 : 0.1;
        return Eigen::Array3d(Eigen::Array3d::Constant(L));
      }));
  EXPECT_EQ(0u, spread.pixels);
  EXPECT_EQ(0.0, spread.Floor());
}

TEST(LikeNormals, ASharpReflectionIsHardlyASpread) {
  // Checkers of 2 degrees: a few to a cell.
  const Image normals = SurfaceNormals(96, Bumps);
  const auto checkered = [](const Eigen::Vector3d& n, int, int) {
    const bool even =
        static_cast<int>(std::floor(30 * n.x()) + std::floor(30 * n.y())) % 2 ==
        0;
    return Eigen::Array3d(Eigen::Array3d::Constant(even ? 1.0 : 0.5));
  };
  // Log radiance itself deviates by half of log 2 from its mean.
  EXPECT_LT(SpreadOf(normals, Painted(normals, checkered)).log_radiance, 0.2);
}

TEST(LikeNormals, FlatPiecesHaveNoSlopes) {
  Image normals(64, 64);
  for (size_t i = 0; i < normals.num_pixels(); ++i) {
    normals.rgb[3 * i + 2] = 1.0f;
  }
  const LikeNormalsSpread spread = SpreadOf(
      normals, Painted(normals, [](const Eigen::Vector3d&, int x, int) {
        return Eigen::Array3d(
            Eigen::Array3d::Constant(x % 2 == 0 ? 1.0 : std::exp(1.0)));
      }));
  EXPECT_GT(spread.pixels, 0u);
  EXPECT_TRUE(std::isfinite(spread.log_radiance));
  EXPECT_LT(spread.log_radiance, 0.7);
  EXPECT_NEAR(0.0, spread.log_colour, 1e-6);
}

// Turns the directions to the viewer as a camera at this distance sees them.
std::vector<ShadingPoint> FromNear(std::vector<ShadingPoint> points, int size,
                                   float distance) {
  for (ShadingPoint& point : points) {
    const auto half = 0.5f * static_cast<float>(size);
    const float u = (static_cast<float>(point.pixel % size) + 0.5f) / half;
    const float v = (static_cast<float>(point.pixel / size) + 0.5f) / half;
    point.wo = Eigen::Vector3f(1.0f - u, v - 1.0f, distance).normalized();
  }
  return points;
}

TEST(LikeNormals, ANearCameraSetsNoFloor) {
  // A mirror under a sky that brightens to the right.
  constexpr int kSize = 96;
  const Image normals = SurfaceNormals(kSize, Bumps);
  const std::vector<ShadingPoint> points = PointsOf(normals);
  for (const float distance : {4.0f, 400.0f}) {
    const std::vector<ShadingPoint> seen = FromNear(points, kSize, distance);
    Image image(kSize, kSize);
    for (const ShadingPoint& point : seen) {
      const Eigen::Vector3f mirrored =
          2.0f * point.normal.dot(point.wo) * point.normal - point.wo;
      std::fill_n(image.At(point.pixel % kSize, point.pixel / kSize), 3,
                  std::exp(2.0f * mirrored.x()));
    }
    const LikeNormalsSpread spread =
        SpreadOfLikeNormals(SampleNormals(image, seen), seen);
    const bool near = distance < 100.0f;
    EXPECT_EQ(!near, spread.HasFloor());
    EXPECT_EQ(near, spread.log_radiance > 0.05) << spread.log_radiance;
    EXPECT_LT(spread.Floor(), 0.01);
    // Between half of the angle from corner to corner and all of it.
    const double corners = 2.0 * std::atan(std::sqrt(2.0) / distance);
    EXPECT_GE(spread.view_angle, 0.5 * corners);
    EXPECT_LE(spread.view_angle, corners);
  }
}

TEST(LikeNormals, ViewsOfOneDirectionEachHaveAFloor) {
  std::vector<ShadingPoint> points = PointsOf(SurfaceNormals(32, Bumps));
  for (size_t i = 0; i < points.size(); i += 2) {
    points[i].view = 1;
    points[i].wo = Eigen::Vector3f::UnitX();
  }
  EXPECT_TRUE(SpreadOfLikeNormals({}, points).HasFloor());
}

TEST(LikeNormals, NothingToCompareIsNoSpread) {
  const std::vector<ShadingPoint> points(3, PointsOf(SphereNormals(8))[0]);
  const LikeNormalsSpread spread = SpreadOfLikeNormals({}, points);
  EXPECT_EQ(0u, spread.pixels);
  EXPECT_EQ(0.0, spread.Floor());
  ASSERT_EQ(3u, spread.colour_of_point.size());
  EXPECT_TRUE(std::isnan(spread.colour_of_point[1]));
}

}  // namespace
}  // namespace ibrdf
