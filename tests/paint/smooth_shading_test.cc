#include "ibrdf/solvers/paint/smooth_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/first_paint.h"
#include "painted_ball.h"

namespace ibrdf {
namespace {

// Log irradiance of a sky that is bright and blue above, of degree 2.
Eigen::Array3d LogSky(const Eigen::Vector3d& n) {
  const double luminance =
      0.6 * n.y() - 0.3 * n.x() + 0.25 * n.x() * n.y() - 0.2 * n.z() * n.z();
  return luminance + Eigen::Array3d(-0.1, 0.0, 0.1) * n.y();
}

// Stripes as of wood: across, each darkens and browns slowly, and ends sharply.
Eigen::Array3d WoodGrain(int x, int y) {
  const double place = std::fmod(x + 4.0 * std::sin(0.1 * y) + 100.0, 19.0);
  return -place / 19.0 * Eigen::Array3d(0.8, 1.0, 1.3);
}

// A ball of log albedo paint(x, y) under that sky.
PaintedBall BallUnderSky(const std::function<Eigen::Array3d(int, int)>& paint) {
  PaintedBall ball = MakePaintedBall(ShadingLight());
  ball.log_albedo.clear();
  ball.radiance.clear();
  for (const ShadingPoint& point : ball.points) {
    const Eigen::Array3d a =
        paint(point.pixel % kBallWidth, point.pixel / kBallWidth);
    const Eigen::Array3d radiance =
        (a + LogSky(point.normal.cast<double>())).exp();
    ball.log_albedo.insert(ball.log_albedo.end(), a.begin(), a.end());
    ball.radiance.insert(ball.radiance.end(), radiance.begin(), radiance.end());
  }
  return ball;
}

// The difference of log radiance from LogSky's, each channel about its mean.
double ErrorOf(const PaintedBall& ball, const std::vector<double>& shading) {
  std::vector<double> found, truth;
  for (size_t i = 0; i < shading.size(); ++i) {
    found.push_back(std::log(shading[i]));
    truth.push_back(LogSky(ball.points[i / 3].normal.cast<double>())[i % 3]);
  }
  return AlignedRmse(found, truth);
}

std::vector<double> ShadingOf(const PaintedBall& ball) {
  return SmoothShading(ball.points, MakeObservations(ball.radiance),
                       NeighboursOf(ball.points, kBallWidth));
}

TEST(SmoothShading, IsTheSkysUnderPatchesOfPaint) {
  const PaintedBall ball = BallUnderSky(PaintAt);
  EXPECT_LT(ErrorOf(ball, ShadingOf(ball)), 0.02);
}

TEST(SmoothShading, IsTheSkysUnderGrain) {
  const PaintedBall ball = BallUnderSky(WoodGrain);
  const std::vector<double> even(ball.radiance.size(), 1.0);
  EXPECT_LT(ErrorOf(ball, ShadingOf(ball)), 0.4 * ErrorOf(ball, even));
}

// Steps of wood's grain go one way: summed up, they are a slope that is not
// there.
TEST(SmoothShading, TellsGrainInTheFirstPaint) {
  const PaintedBall ball = BallUnderSky(WoodGrain);
  const FirstPaint found =
      FindFirstPaint(ball.points, MakeObservations(ball.radiance),
                     NeighboursOf(ball.points, kBallWidth));
  EXPECT_TRUE(found.natural_light);
  EXPECT_FALSE(found.options.chroma_drifts);
  UnpaintedRadiance even;
  even.matte.assign(ball.radiance.size(), 1.0);
  even.gloss.assign(ball.radiance.size(), 0.0);
  AlbedoFitOptions drift;
  drift.chroma_drifts = true;
  const Observations observed = MakeObservations(ball.radiance);
  const std::vector<double> summed = FitAlbedo(
      {{&even, &observed}}, NeighboursOf(ball.points, kBallWidth), drift);
  EXPECT_LT(AlignedRmse(found.log_albedo, ball.log_albedo),
            0.4 * AlignedRmse(summed, ball.log_albedo));
}

TEST(SmoothShading, OfFewPointsIsEven) {
  EXPECT_TRUE(SmoothShading({}, MakeObservations({}), {}).empty());
  PaintedBall ball = BallUnderSky(PaintAt);
  ball.points.resize(2);
  ball.radiance.resize(6);
  for (const double s : ShadingOf(ball)) EXPECT_EQ(s, 1.0);
}

TEST(ColourEntropy, CountsColours) {
  const PaintedBall ball = BallUnderSky(PaintAt);
  Observations observed = MakeObservations(ball.radiance);
  std::vector<double> paint(ball.radiance.size(), 0.3);
  EXPECT_NEAR(ColourEntropy(ball.points, observed, paint), 0.0, 1e-12);
  for (size_t i = 0; i < paint.size(); ++i) {
    if (i / 3 % 2 == 0) paint[i] = -5.0;
  }
  EXPECT_NEAR(ColourEntropy(ball.points, observed, paint), std::log(2.0), 1e-2);
  for (size_t i = 0; i < paint.size(); i += 6) observed.valid[i / 3] = 0;
  EXPECT_NEAR(ColourEntropy(ball.points, observed, paint), 0.0, 1e-12);
  observed.valid.assign(observed.valid.size(), 0);
  EXPECT_EQ(ColourEntropy(ball.points, observed, paint), 0.0);
}

}  // namespace
}  // namespace ibrdf
