#include "solvers/bench/sphere_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/render/render_testing.h"

namespace ibrdf {
namespace {

constexpr Sphere kSpheres[] = {Sphere::kMirror, Sphere::kDiffuse,
                               Sphere::kGlossy};

TEST(SphereMetrics, MirrorShowsTheMap) {
  const Image map = testing::SmoothMap(64, 128);
  const Image sphere = RenderSphere(map, Sphere::kMirror, 1);
  // The pixels in the middle see what lies behind the camera, at +z; a pixel
  // of 128 turns the ray by 2 degrees.
  const Eigen::Array3d front = LookUpMap(map, Eigen::Vector3d::UnitZ());
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(front[c], sphere.At(63, 63)[c], 0.03 * front[c]);
  }
  EXPECT_EQ(0.0f, sphere.At(0, 0)[0]);
}

TEST(SphereMetrics, DiffuseSphereIsWhiteInAWhiteFurnace) {
  const Image sphere =
      RenderSphere(testing::ConstantMap(16, 32, 1.0f), Sphere::kDiffuse, 1);
  EXPECT_NEAR(1.0f, sphere.At(sphere.width / 2, sphere.height / 2)[1], 1e-5);
}

TEST(SphereMetrics, OneScaleIsFree) {
  const Image map = testing::SmoothMap(32, 64);
  Image scaled = map, tinted = map;
  for (size_t i = 0; i < map.rgb.size(); ++i) {
    scaled.rgb[i] *= 7.0f;
    tinted.rgb[i] *= i % 3 == 0 ? 2.0f : 1.0f;
  }
  for (const Sphere sphere : kSpheres) {
    const SphereMetrics same = CompareSpheres(scaled, map, sphere, 1).value();
    // Float rounding of radiance around 1.
    EXPECT_NEAR(0.0, same.rmse, 1e-5) << SphereName(sphere);
    EXPECT_NEAR(0.0, same.log_rmse, 1e-5);
    EXPECT_NEAR(0.0, same.dssim, 1e-5);
    EXPECT_LT(0.05, CompareSpheres(tinted, map, sphere, 1)->log_rmse);
  }
}

TEST(SphereMetrics, ClosedFormOfTwoGreys) {
  // r = (1, 1, 4), e = 1: s = 2, errors 1, 1, 2.
  Image truth = testing::ConstantMap(16, 32, 1.0f);
  for (size_t i = 2; i < truth.rgb.size(); i += 3) truth.rgb[i] = 4.0f;
  const SphereMetrics m = CompareSpheres(testing::ConstantMap(16, 32, 1.0f),
                                         truth, Sphere::kMirror, 1)
                              .value();
  EXPECT_NEAR(std::sqrt(2.0), m.rmse, 1e-5);
  const double up = std::log(3.0 / 2.0), down = std::log(3.0 / 5.0);
  EXPECT_NEAR(std::sqrt((2 * up * up + down * down) / 3), m.log_rmse, 1e-5);
}

TEST(SphereMetrics, Extremes) {
  const Image map = testing::SmoothMap(16, 32);
  Image sun = map;
  for (int c = 0; c < 3; ++c) sun.At(3, 8)[c] = 1e9f;
  for (const Sphere sphere : kSpheres) {
    const SphereMetrics m = CompareSpheres(map, sun, sphere, 1).value();
    EXPECT_TRUE(std::isfinite(m.rmse) && std::isfinite(m.log_rmse));
    // A black estimate has nothing to scale.
    EXPECT_TRUE(std::isfinite(
        CompareSpheres(testing::ConstantMap(16, 32, 0.0f), map, sphere, 1)
            ->log_rmse));
  }
  sun.rgb[0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(0u, CompareSpheres(sun, map, Sphere::kMirror, 1)
                    .status()
                    .message()
                    .find("estimate"));
  EXPECT_FALSE(CompareSpheres(map, testing::ConstantMap(16, 32, 0.0f),
                              Sphere::kMirror, 1)
                   .ok());
}

}  // namespace
}  // namespace ibrdf
