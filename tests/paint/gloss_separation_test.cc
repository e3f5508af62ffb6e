#include "ibrdf/solvers/paint/gloss_separation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "painted_ball.h"

namespace ibrdf {
namespace {

const Eigen::Array3d kMatteAlbedo(0.5, 0.4, 0.3);

// A ball of one paint, whose chroma drifts a little, under gloss about one
// normal.
struct GlossyBall {
  UnpaintedRadiance unpainted;  // its gloss wider than it is, and reddish
  std::vector<double> log_albedo, gloss, radiance;
  std::vector<NeighbourPair> neighbours;

  std::vector<double> Separate() const {
    const Observations observed = MakeObservations(radiance);
    return SeparateGloss({&unpainted, &observed}, log_albedo, kMatteAlbedo,
                         neighbours, AlbedoFitOptions());
  }
};

double Highlight(const ShadingPoint& point, double width) {
  const Eigen::Vector3f at = Eigen::Vector3f(0.3f, 0.3f, 0.9f).normalized();
  return std::exp(-(point.normal - at).squaredNorm() / (width * width));
}

// chroma: of the paint, log. light: its colour.
GlossyBall MakeGlossyBall(const Eigen::Array3d& chroma,
                          const Eigen::Array3d& light = {1.0, 1.0, 1.0}) {
  ShadingLight lamp;
  lamp.strength = 1.5;
  const PaintedBall ball = MakePaintedBall(lamp);
  GlossyBall out;
  out.neighbours = NeighboursOf(ball.points, kBallWidth);
  const Eigen::Array3d red(1.6, 0.9, 0.5);
  for (const ShadingPoint& point : ball.points) {
    const Eigen::Array3d E =
        light * Irradiance(lamp, point.normal.cast<double>());
    const Eigen::Array3d a = chroma * (1.0 + 0.2 * point.normal.x());
    const Eigen::Array3d matte = kMatteAlbedo * E;
    const Eigen::Array3d gloss = 1.5 * Highlight(point, 0.15) * light;
    const Eigen::Array3d rendered = Highlight(point, 0.4) * red * light;
    for (int c = 0; c < 3; ++c) {
      out.log_albedo.push_back(a[c]);
      out.unpainted.matte.push_back(matte[c]);
      out.unpainted.gloss.push_back(rendered[c]);
      out.gloss.push_back(gloss[c]);
      out.radiance.push_back(std::exp(a[c]) * matte[c] + gloss[c]);
    }
  }
  return out;
}

double Sum(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  return sum;
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  const double mean_a = Sum(a) / n, mean_b = Sum(b) / n;
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return ab / std::sqrt(aa * bb);
}

TEST(SeparateGloss, VividPaintTellsItsGloss) {
  const GlossyBall ball = MakeGlossyBall({0.9, -0.2, -0.7});
  const std::vector<double> found = ball.Separate();
  EXPECT_LT(Correlation(ball.unpainted.gloss, ball.gloss), 0.75);
  EXPECT_GT(Correlation(found, ball.gloss), 0.93);
  EXPECT_GT(Sum(ball.unpainted.gloss), 3.0 * Sum(ball.gloss));
  EXPECT_LT(Sum(found), 2.3 * Sum(ball.gloss));
  EXPECT_GT(Sum(found), 0.8 * Sum(ball.gloss));
}

// Grey gloss on grey paint has no colour that would tell it: the render stays,
// under the shading that the image has.
TEST(SeparateGloss, GreyPaintKeepsTheRender) {
  GlossyBall ball = MakeGlossyBall(-kMatteAlbedo.log());
  for (size_t i = 0; i < ball.gloss.size(); ++i) {
    ball.log_albedo[i] = -std::log(kMatteAlbedo[static_cast<int>(i % 3)]);
    ball.unpainted.gloss[i] =
        0.4 * ball.unpainted.matte[i] / kMatteAlbedo[static_cast<int>(i % 3)];
    ball.radiance[i] =
        0.7 * (std::exp(ball.log_albedo[i]) * ball.unpainted.matte[i] +
               ball.unpainted.gloss[i]);
  }
  const std::vector<double> found = ball.Separate();
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], 0.7 * ball.unpainted.gloss[i], 1e-6 * found[i]);
  }
}

TEST(SeparateGloss, IsOfTheLightsColour) {
  const Eigen::Array3d light(1.5, 1.0, 0.4);
  const GlossyBall ball = MakeGlossyBall({0.9, -0.2, -0.7}, light);
  const std::vector<double> found = ball.Separate();
  for (size_t i = 0; i < found.size(); i += 3) {
    EXPECT_NEAR(found[i] / light[0], found[i + 1] / light[1], 1e-9);
    EXPECT_NEAR(found[i] / light[0], found[i + 2] / light[2], 1e-9);
  }
  // A coloured light is no reason for another gloss.
  const std::vector<double> under_grey =
      MakeGlossyBall({0.9, -0.2, -0.7}).Separate();
  EXPECT_NEAR(Sum(found) / (light.sum() / 3.0), Sum(under_grey),
              0.05 * Sum(under_grey));
}

TEST(SeparateGloss, UnitsScaleIt) {
  GlossyBall ball = MakeGlossyBall({0.9, -0.2, -0.7});
  const std::vector<double> before = ball.Separate();
  for (std::vector<double>* values :
       {&ball.unpainted.matte, &ball.unpainted.gloss, &ball.radiance}) {
    for (double& v : *values) v *= 1024.0;
  }
  const std::vector<double> after = ball.Separate();
  for (size_t i = 0; i < after.size(); ++i) {
    EXPECT_NEAR(after[i], 1024.0 * before[i], 1e-9 * after[i]);
  }
}

TEST(SeparateGloss, IsFiniteAtExtremes) {
  GlossyBall ball = MakeGlossyBall({3.0, 0.0, -3.0});
  ball.radiance[0] = -1.0;
  ball.radiance[3] = 1e300;
  ball.radiance[6] = 1e-300;
  ball.unpainted.matte[9] = 0.0;
  for (size_t i = 12; i < 15; ++i) ball.unpainted.gloss[i] = 0.0;
  for (size_t i = 15; i < 18; ++i) ball.unpainted.gloss[i] = 1e6;
  const std::vector<double> found = ball.Separate();
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(std::isfinite(found[i]) && found[i] >= 0.0) << i;
  }
  EXPECT_EQ(0.0, found[12]);
  for (size_t i = 15; i < 18; ++i) EXPECT_LE(found[i], ball.radiance[i]);
}

}  // namespace
}  // namespace ibrdf
