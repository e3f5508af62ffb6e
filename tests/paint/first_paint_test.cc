#include "ibrdf/solvers/paint/first_paint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "painted_ball.h"

namespace ibrdf {
namespace {

ShadingLight SomeLamp() {
  ShadingLight lamp;
  lamp.direction = Eigen::Vector3d(-0.6, 0.3, 0.7).normalized();
  lamp.strength = 6.0;
  lamp.chroma = {0.1, 0.05};
  return lamp;
}

FirstPaint Find(const PaintedBall& ball) {
  return FindFirstPaint(ball.points, MakeObservations(ball.radiance),
                        NeighboursOf(ball.points, kBallWidth));
}

TEST(FirstPaint, IsThePaintWithoutTheShading) {
  const PaintedBall ball = MakePaintedBall(SomeLamp());
  const FirstPaint found = Find(ball);
  EXPECT_TRUE(found.light.has_value());
  EXPECT_LT(AlignedRmse(found.log_albedo, ball.log_albedo), 0.03);
  EXPECT_LT(found.deviation, 0.03);
  double sum = 0.0;
  for (size_t i = 0; i < found.log_albedo.size(); i += 3) {
    sum += found.log_albedo[i];
  }
  EXPECT_NEAR(sum, 0.0, 1e-6);
}

// A highlight is white and bright, as a spot of paint could be.
TEST(FirstPaint, TakesNoHighlightForPaint) {
  PaintedBall ball = MakePaintedBall(SomeLamp());
  const Eigen::Vector3d half =
      (SomeLamp().direction + Eigen::Vector3d::UnitZ()).normalized();
  std::vector<size_t> shiny;
  for (size_t i = 0; i < ball.points.size(); ++i) {
    const double sine = ball.points[i].normal.cast<double>().cross(half).norm();
    const double gloss = 20.0 * std::exp(-sine * sine / 0.004);
    for (int c = 0; c < 3; ++c) ball.radiance[3 * i + c] += gloss;
    if (gloss > 4.0) shiny.push_back(i);
  }
  const FirstPaint found = Find(ball);
  double above = 0.0;
  for (const size_t i : shiny) {
    for (int c = 0; c < 3; ++c) {
      above += (found.log_albedo[3 * i + c] - ball.log_albedo[3 * i + c]) /
               (3.0 * shiny.size());
    }
  }
  // Were it paint, it would be log(20 / 5) and more.
  EXPECT_GT(shiny.size(), 10u);
  EXPECT_LT(above, 1.0);
}

// What neither paint nor light explains is said, so that it is not believed.
TEST(FirstPaint, SaysHowMuchLikeNormalsDiffer) {
  PaintedBall ball = MakePaintedBall(SomeLamp());
  for (size_t i = 0; i < ball.radiance.size(); ++i) {
    const size_t p = i / 3;
    ball.radiance[i] *= std::exp(0.08 * std::sin(1.7 * p));
  }
  const double deviation = Find(ball).deviation;
  EXPECT_GT(deviation, 0.03);
  EXPECT_LT(deviation, 0.15);
}

// A shadow in each of three photographs, by a lamp at another place in each.
TEST(SharedPaint, IsBetterThanThatOfEachPhotograph) {
  std::vector<PaintedBall> balls;
  std::vector<FirstPaint> alone;
  std::vector<Observations> observed;
  for (int k = 0; k < 3; ++k) {
    ShadingLight lamp = SomeLamp();
    lamp.direction = Eigen::Vector3d(0.6 * (k - 1), 0.3, 0.7).normalized();
    PaintedBall ball = MakePaintedBall(lamp);
    const size_t points = ball.points.size();
    for (size_t i = (k + 1) * points / 5; i < (k + 2) * points / 5; ++i) {
      for (int c = 0; c < 3; ++c) ball.radiance[3 * i + c] *= 0.4;
    }
    alone.push_back(Find(ball));
    observed.push_back(MakeObservations(ball.radiance));
    balls.push_back(std::move(ball));
  }
  const SharedPaint shared = FindSharedPaint(
      balls[0].points, {&observed[0], &observed[1], &observed[2]}, alone,
      NeighboursOf(balls[0].points, kBallWidth));
  const std::vector<double>& truth = balls[0].log_albedo;
  for (const FirstPaint& one : alone) {
    EXPECT_LT(AlignedRmse(shared.log_albedo, truth),
              0.4 * AlignedRmse(one.log_albedo, truth));
  }
}

TEST(FirstPaint, OfOnePixelIsFinite) {
  PaintedBall ball = MakePaintedBall(SomeLamp());
  ball.points.resize(1);
  ball.radiance.resize(3);
  for (const double a : Find(ball).log_albedo) EXPECT_NEAR(a, 0.0, 1e-9);
  EXPECT_EQ(Find(ball).deviation, 0.0);
  EXPECT_TRUE(Find(PaintedBall()).log_albedo.empty());
}

}  // namespace
}  // namespace ibrdf
