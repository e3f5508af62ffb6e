#include "ibrdf/solvers/paint/shading_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ibrdf/base/pi.h"
#include "painted_ball.h"

namespace ibrdf {
namespace {

ShadingLight Lamp(const Eigen::Vector3d& direction, double strength) {
  ShadingLight lamp;
  lamp.direction = direction.normalized();
  lamp.strength = strength;
  lamp.chroma = {0.12, -0.08};
  return lamp;
}

// A deviation of luminance, in a pattern that knows nothing of the normals.
double Grain(size_t i) { return std::sin(12.9898 * i) * std::cos(78.233 * i); }

TEST(ShadingLight, IsFoundThroughPaintGrainAndShadows) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(-0.6, 0.3, 0.7), Eigen::Vector3d(0.9, 0.1, 0.1),
        Eigen::Vector3d(0.0, 0.2, 1.0)}) {
    const ShadingLight lamp = Lamp(direction, 8.0);
    PaintedBall ball = MakePaintedBall(lamp);
    for (size_t i = 0; i < ball.radiance.size(); ++i) {
      ball.radiance[i] *= std::exp(0.1 * Grain(i / 3));
      if (i / 3 % 10 == 0) ball.radiance[i] *= 0.3;  // in shadow
    }
    const auto found =
        FindShadingLight(ball.points, MakeObservations(ball.radiance));
    ASSERT_TRUE(found.has_value());
    EXPECT_LT(std::acos(std::min(1.0, found->direction.dot(lamp.direction))),
              3.0 * kDegree);
    EXPECT_NEAR(std::log(found->strength / lamp.strength), 0.0, 0.2);
    EXPECT_LT((found->chroma - lamp.chroma).matrix().norm(), 0.04);
  }
}

TEST(ShadingLight, OfEvenLightIsNone) {
  PaintedBall ball = MakePaintedBall(ShadingLight());
  for (size_t i = 0; i < ball.radiance.size(); ++i) {
    ball.radiance[i] *= std::exp(0.05 * Grain(i / 3));
  }
  EXPECT_FALSE(FindShadingLight(ball.points, MakeObservations(ball.radiance))
                   .has_value());
}

TEST(ShadingLight, NeedsPartners) {
  const PaintedBall ball = MakePaintedBall(Lamp({0, 0, 1}, 8.0));
  EXPECT_FALSE(FindShadingLight({}, MakeObservations({})).has_value());
  const std::vector<ShadingPoint> one(1, ball.points[0]);
  EXPECT_FALSE(
      FindShadingLight(one, MakeObservations({0.1, 0.2, 0.3})).has_value());
  // No two of one colour.
  std::vector<double> radiance(ball.radiance.size());
  for (size_t i = 0; i < radiance.size(); ++i) {
    radiance[i] = std::exp(i % 3 == 0 ? 0.001 * i
                                      : (i % 3 == 1 ? -1.0 : 1.0) * 0.0007 * i *
                                            i * 1e-3);
  }
  const auto found =
      FindShadingLight(ball.points, MakeObservations(std::move(radiance)));
  if (found.has_value()) {
    EXPECT_TRUE(found->direction.allFinite() && std::isfinite(found->strength));
  }
}

TEST(ShadingLight, OfUnusableRadianceIsNone) {
  PaintedBall ball = MakePaintedBall(ShadingLight());
  const double bad[] = {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i < ball.radiance.size(); ++i) {
    ball.radiance[i] = bad[i % 4];
  }
  EXPECT_FALSE(FindShadingLight(ball.points, MakeObservations(ball.radiance))
                   .has_value());
}

TEST(ShadingLight, IrradianceIsOfTheRoomBehindTheLamp) {
  const ShadingLight lamp = Lamp({0, 0, 1}, 5.0);
  const Eigen::Array3d behind = Irradiance(lamp, -Eigen::Vector3d::UnitZ());
  const Eigen::Array3d before = Irradiance(lamp, Eigen::Vector3d::UnitZ());
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(behind[c], 1.0, 0.01);
    EXPECT_GT(before[c], 4.0);
  }
  EXPECT_NEAR((before - 1.0).log().mean(), std::log(5.0), 0.01);
}

}  // namespace
}  // namespace ibrdf
