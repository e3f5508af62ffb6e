#include "ibrdf/solvers/bench/sphere_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/sample_merl.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {

// Its tables are made once.
const SphereGallery& Gallery() {
  static const SphereGallery gallery(1);
  return gallery;
}

TEST(SphereMetrics, MirrorShowsTheMap) {
  const Image map = testing::SmoothMap(64, 128);
  const Image sphere = Gallery().Render(map)[0];
  // The pixels in the middle see what lies behind the camera, at +z; a pixel
  // of 128 turns the ray by 2 degrees.
  const Eigen::Array3d front = LookUpMap(map, Eigen::Vector3d::UnitZ());
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(front[c], sphere.At(63, 63)[c], 0.03 * front[c]);
  }
  EXPECT_EQ(0.0f, sphere.At(0, 0)[0]);
}

TEST(SphereMetrics, DiffuseSphereIsWhiteInAWhiteFurnace) {
  const Image sphere = Gallery().Render(testing::ConstantMap(16, 32, 1.0f))[1];
  EXPECT_NEAR(1.0f, sphere.At(sphere.width / 2, sphere.height / 2)[1], 1e-5);
}

TEST(SphereMetrics, OneScaleIsFree) {
  const Image map = testing::SmoothMap(32, 64);
  Image scaled = map, tinted = map;
  for (size_t i = 0; i < map.rgb.size(); ++i) {
    scaled.rgb[i] *= 7.0f;
    tinted.rgb[i] *= i % 3 == 0 ? 2.0f : 1.0f;
  }
  const auto same = Gallery().Compare(scaled, map).value();
  const auto other = Gallery().Compare(tinted, map).value();
  for (int k = 0; k < kNumSpheres; ++k) {
    // Float rounding of radiance around 1.
    EXPECT_NEAR(0.0, same[k].rmse, 1e-5) << k;
    EXPECT_NEAR(0.0, same[k].log_rmse, 1e-5) << k;
    EXPECT_NEAR(0.0, same[k].dssim, 1e-5) << k;
    EXPECT_LT(0.05, other[k].log_rmse) << k;
  }
}

TEST(SphereMetrics, ClosedFormOfTwoGreys) {
  // r = (1, 1, 4), e = 1: s = 2, errors 1, 1, 2.
  Image truth = testing::ConstantMap(16, 32, 1.0f);
  for (size_t i = 2; i < truth.rgb.size(); i += 3) truth.rgb[i] = 4.0f;
  const SphereMetrics m =
      Gallery().Compare(testing::ConstantMap(16, 32, 1.0f), truth).value()[0];
  EXPECT_NEAR(std::sqrt(2.0), m.rmse, 1e-5);
  const double up = std::log(3.0 / 2.0), down = std::log(3.0 / 5.0);
  EXPECT_NEAR(std::sqrt((2 * up * up + down * down) / 3), m.log_rmse, 1e-5);
}

TEST(SphereMetrics, MirrorsAreTheGallerys) {
  const Image map = testing::SmoothMap(32, 64),
              other = testing::ConstantMap(32, 64, 1.0f);
  const SphereMetrics alone = CompareMirrors(other, map).value();
  const SphereMetrics one = Gallery().Compare(other, map).value()[0];
  EXPECT_GT(alone.log_rmse, 0.01);
  EXPECT_EQ(one.log_rmse, alone.log_rmse);
  EXPECT_EQ(one.dssim, alone.dssim);
}

TEST(SphereMetrics, RelitReflectanceHasOneFreeScale) {
  const MerlTable truth = SampleMerl(testing::Glossy(0.3, 0.5, 20.0));
  const Image map = testing::SmoothMap(32, 64);
  MerlTable scaled = truth, red = truth;
  for (size_t i = 0; i < truth.raw.size(); ++i) {
    scaled.raw[i] *= 5.0;
    red.raw[i] *= i < kMerlBins ? 2.0 : 1.0;
  }
  const SphereMetrics same = CompareRelit(scaled, truth, map, 1).value();
  EXPECT_NEAR(0.0, same.log_rmse, 1e-5);
  EXPECT_NEAR(0.0, same.dssim, 1e-5);
  EXPECT_LT(0.05, CompareRelit(red, truth, map, 1).value().log_rmse);
  // Closed form where all that is seen is white: (1, 1, 1) for (2, 1, 1).
  const MerlTable matte = SampleMerl(
      [](double, double, double) { return Eigen::Array3d::Constant(1 / kPi); });
  MerlTable pink = matte;
  for (int i = 0; i < kMerlBins; ++i) pink.raw[i] *= 2.0;
  const SphereMetrics furnace =
      CompareRelit(pink, matte, testing::ConstantMap(32, 64, 1.0f), 1).value();
  // s = 4/6: errors 1/3, 1/3, 1/3.
  EXPECT_NEAR(1.0 / 3.0, furnace.rmse, 1e-3);
}

TEST(SphereMetrics, RelitRefusesWhatCannotBeCompared) {
  const MerlTable truth = SampleMerl(testing::Glossy(0.3, 0.5, 20.0));
  Image map = testing::SmoothMap(16, 32);
  MerlTable black = truth;
  for (double& v : black.raw) v = std::min(v, 0.0);
  EXPECT_TRUE(std::isfinite(CompareRelit(black, truth, map, 1)->log_rmse));
  EXPECT_EQ(
      0u,
      CompareRelit(truth, black, map, 1).status().message().find("reference"));
  map.rgb[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(0u,
            CompareRelit(truth, truth, map, 1).status().message().find("map"));
}

TEST(SphereMetrics, Extremes) {
  const Image map = testing::SmoothMap(16, 32);
  Image sun = map;
  for (int c = 0; c < 3; ++c) sun.At(3, 8)[c] = 1e9f;
  const auto hard = Gallery().Compare(map, sun).value();
  // A black estimate has nothing to scale.
  const auto black =
      Gallery().Compare(testing::ConstantMap(16, 32, 0.0f), map).value();
  for (int k = 0; k < kNumSpheres; ++k) {
    EXPECT_TRUE(std::isfinite(hard[k].rmse) && std::isfinite(hard[k].log_rmse));
    EXPECT_TRUE(std::isfinite(black[k].log_rmse));
  }
  sun.rgb[0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(0u,
            Gallery().Compare(sun, map).status().message().find("estimate"));
  EXPECT_FALSE(Gallery().Compare(map, testing::ConstantMap(16, 32, 0.0f)).ok());
}

}  // namespace
}  // namespace ibrdf
