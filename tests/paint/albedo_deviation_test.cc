#include "ibrdf/solvers/paint/albedo_deviation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "painted_ball.h"

namespace ibrdf {
namespace {

constexpr int kSide = 40;
// Conjugate gradients' relative tolerance is 1e-5.
constexpr double kTolerance = 1e-4;

// A flat sheet in even light, grey but for a stripe, and what an image of it
// says beyond its albedo: `offset`, of alternating sign.
struct Sheet {
  UnpaintedRadiance unpainted;
  std::vector<double> log_albedo, radiance;
  std::vector<NeighbourPair> neighbours;
  Observations observed;

  // offset(x, y): of log radiance.
  template <typename Offset>
  void ObserveWith(Offset offset) {
    radiance.resize(log_albedo.size());
    for (size_t k = 0; k < radiance.size(); ++k) {
      const auto pixel = static_cast<int>(k / 3);
      radiance[k] =
          std::exp(log_albedo[k] + offset(pixel % kSide, pixel / kSide)) *
              unpainted.matte[k] +
          unpainted.gloss[k];
    }
    observed = MakeObservations(radiance);
  }
  void Observe(double offset) {
    ObserveWith(
        [&](int x, int y) { return (x + y) % 2 == 0 ? offset : -offset; });
  }
  std::vector<double> LogStd() const {
    return AlbedoLogStd({{&unpainted, &observed}}, neighbours, log_albedo, {});
  }
};

Sheet MakeSheet(double offset) {
  Sheet sheet;
  std::vector<ShadingPoint> points(kSide * kSide);
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].pixel = static_cast<int>(i);
    points[i].normal = Eigen::Vector3f::UnitZ();
  }
  sheet.neighbours = NeighboursOf(points, kSide);
  for (size_t k = 0; k < 3 * points.size(); ++k) {
    const bool stripe = k / 3 / kSide % 8 == 0;
    sheet.log_albedo.push_back(stripe ? -1.0 : -0.5);
  }
  sheet.unpainted.matte.assign(3 * points.size(), 0.5);
  sheet.unpainted.gloss.assign(3 * points.size(), 0.0);
  sheet.Observe(offset);
  return sheet;
}

double Most(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// The error of shading, and light of 0.1 of the mean that may be missing.
TEST(AlbedoLogStd, IsThatOfTheDisagreement) {
  const double expected = std::hypot(0.1, std::log1p(0.1));
  for (const double std : MakeSheet(0.1).LogStd()) {
    EXPECT_NEAR(expected, std, kTolerance);
  }
}

TEST(AlbedoLogStd, IsNoneWithoutAnyError) {
  EXPECT_LT(Most(MakeSheet(0.0).LogStd()), 1e-6);
}

TEST(AlbedoLogStd, GlossMayBeNone) {
  Sheet sheet = MakeSheet(0.0);
  for (size_t k = 0; k < sheet.log_albedo.size(); ++k) {
    sheet.unpainted.gloss[k] =
        3.0 * std::exp(sheet.log_albedo[k]) * sheet.unpainted.matte[k];
  }
  sheet.Observe(0.0);
  for (const double std : sheet.LogStd()) {
    EXPECT_NEAR(std::log(4.0), std, kTolerance);
  }
  AlbedoFitOptions known;
  known.gloss_error = 0.1;
  for (const double std :
       AlbedoLogStd({{&sheet.unpainted, &sheet.observed}}, sheet.neighbours,
                    sheet.log_albedo, known)) {
    EXPECT_NEAR(std::log(1.3), std, kTolerance);
  }
}

// The left half has a third of the light of the right: 0.5 and 1.5 of the mean.
TEST(AlbedoLogStd, IsLargerInTheDark) {
  Sheet sheet = MakeSheet(0.0);
  for (size_t k = 0; k < sheet.log_albedo.size(); ++k) {
    if (k / 3 % kSide < kSide / 2) sheet.unpainted.matte[k] /= 3.0;
  }
  sheet.Observe(0.1);
  const std::vector<double> std = sheet.LogStd();
  // The upper of the middle two of |r| E.
  const double missing = 0.1 * 1.5;
  EXPECT_NEAR(std::hypot(0.1, std::log1p(missing / 0.5)), std[3 * kSide + 2],
              kTolerance);
  EXPECT_NEAR(std::hypot(0.1, std::log1p(missing / 1.5)), std[4 * kSide - 2],
              kTolerance);
}

TEST(AlbedoLogStd, IsLargerWhereTheShadingIsWrong) {
  Sheet sheet = MakeSheet(0.02);
  const Sheet wrong = MakeSheet(0.4);
  for (size_t k = 0; k < sheet.radiance.size() / 4; ++k) {
    sheet.radiance[k] = wrong.radiance[k];
  }
  sheet.observed = MakeObservations(sheet.radiance);
  const std::vector<double> std = sheet.LogStd();
  EXPECT_NEAR(0.4, std[3 * kSide + 20], 0.05);
  EXPECT_NEAR(0.03, std[35 * kSide + 20], 0.01);
}

// Light of the mean is missing by 0.05, so that nothing is known without error.
TEST(AlbedoLogStd, GrowsIntoAHole) {
  Sheet sheet = MakeSheet(0.05);
  const auto in_hole = [](int x, int y) {
    return (x - 20) * (x - 20) + (y - 20) * (y - 20) <= 64;
  };
  for (int i = 0; i < kSide * kSide; ++i) {
    if (in_hole(i % kSide, i / kSide)) sheet.observed.valid[i] = 0;
  }
  const std::vector<double> std = sheet.LogStd();
  double seen = 0.0;
  for (int i = 0; i < kSide * kSide; ++i) {
    if (!in_hole(i % kSide, i / kSide)) seen = std::max(seen, std[i]);
  }
  const double edge = std[20 * kSide + 12], middle = std[20 * kSide + 20];
  EXPECT_GT(edge, 1.2 * seen);
  EXPECT_GT(middle, 1.2 * edge);
  // The stripe's steps, in one of eight pairs of rows twice: a Gaussian whose
  // variance in the middle is a logarithm of the hole's size.
  EXPECT_LT(middle, 0.5);
}

TEST(AlbedoLogStd, IdenticalLightsChangeNothing) {
  const Sheet sheet = MakeSheet(0.1);
  const PaintedImage image = {&sheet.unpainted, &sheet.observed};
  const std::vector<double> one = sheet.LogStd();
  const std::vector<double> three = AlbedoLogStd(
      {image, image, image}, sheet.neighbours, sheet.log_albedo, {});
  for (size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], three[i], 1e-9);
}

// At two of three points one image says 0.3 more than the first and one 0.3
// less: the median is right, its squared standard error (0.09 + 0.09) / 3 / 3.
TEST(AlbedoLogStd, LightsThatDisagreeSayHowFar) {
  std::vector<Sheet> sheets;
  for (const double offset : {0.0, 0.3, -0.3}) {
    sheets.push_back(MakeSheet(0.0));
    sheets.back().ObserveWith(
        [offset](int x, int y) { return offset * ((x + y) % 3 - 1); });
  }
  std::vector<PaintedImage> images;
  for (const Sheet& sheet : sheets) {
    images.push_back({&sheet.unpainted, &sheet.observed});
  }
  double variance = 0.0, expected = 0.0;
  const std::vector<double> std =
      AlbedoLogStd(images, sheets[0].neighbours, sheets[0].log_albedo, {});
  for (int i = 0; i < kSide * kSide; ++i) {
    variance += std[i] * std[i];
    if ((i % kSide + i / kSide) % 3 != 1) expected += 0.02;
  }
  EXPECT_NEAR(1.0, variance / expected, kTolerance);
}

TEST(AlbedoLogStd, UnitsChangeNothing) {
  Sheet sheet = MakeSheet(0.1);
  sheet.observed.valid[500] = 0;
  const std::vector<double> before = sheet.LogStd();
  for (size_t k = 0; k < sheet.radiance.size(); ++k) {
    sheet.unpainted.matte[k] *= 1024.0;
    sheet.unpainted.gloss[k] *= 1024.0;
    sheet.radiance[k] *= 1024.0;
  }
  sheet.observed = MakeObservations(sheet.radiance);
  sheet.observed.valid[500] = 0;
  EXPECT_EQ(before, sheet.LogStd());
}

TEST(AlbedoLogStd, IsTheMostWhereNothingIsSeen) {
  Sheet sheet = MakeSheet(0.1);
  std::fill(sheet.observed.valid.begin(), sheet.observed.valid.end(), 0);
  for (const double std : sheet.LogStd()) {
    EXPECT_NEAR(kMostOfPaint, std, 1e-6);
  }
}

TEST(AlbedoLogStd, IsFiniteOfAnything) {
  Sheet sheet = MakeSheet(0.1);
  sheet.unpainted.matte[0] = 0.0;
  sheet.unpainted.gloss[3] = 1e300;
  sheet.radiance[6] = 1e300;
  sheet.unpainted.matte[9] = 1e-300;
  sheet.unpainted.matte[12] = 1e300;
  sheet.radiance[15] = -1.0;
  sheet.observed = MakeObservations(sheet.radiance);
  for (const double std : sheet.LogStd()) {
    EXPECT_TRUE(std >= 0.0 && std <= kMostOfPaint);
  }
}

// The shading of the upper half alone is off, and a ball's fitted paint with
// it. What is stated is larger there. It is too large: paints that are all over
// the ball tell more than it counts on.
TEST(AlbedoLogStd, SaysWhereTheFitIsWrong) {
  ShadingLight light;
  light.strength = 1.5;
  const PaintedBall ball = MakePaintedBall(light);
  const std::vector<NeighbourPair> neighbours =
      NeighboursOf(ball.points, kBallWidth);
  UnpaintedRadiance unpainted;
  std::vector<double> radiance = ball.radiance;
  for (size_t k = 0; k < radiance.size(); ++k) {
    const Eigen::Vector3f& n = ball.points[k / 3].normal;
    unpainted.matte.push_back(radiance[k] * std::exp(-ball.log_albedo[k]));
    unpainted.gloss.push_back(0.0);
    if (n.y() > 0.0f) radiance[k] *= std::exp(n.y() * std::sin(4.0 * n.x()));
  }
  const Observations observed = MakeObservations(radiance);
  const std::vector<PaintedImage> images = {{&unpainted, &observed}};
  const std::vector<double> fitted = FitAlbedo(images, neighbours, {});
  const std::vector<double> std = AlbedoLogStd(images, neighbours, fitted, {});
  double stated[2] = {0.0, 0.0}, error[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
  for (size_t k = 0; k < fitted.size(); ++k) {
    const int up = ball.points[k / 3].normal.y() > 0.0f ? 1 : 0;
    error[up] += std::pow(fitted[k] - ball.log_albedo[k], 2);
    stated[up] += std::pow(std[k / 3], 2);
    count[up] += 1.0;
  }
  for (int up = 0; up < 2; ++up) {
    error[up] = std::sqrt(error[up] / count[up]);
    stated[up] = std::sqrt(stated[up] / count[up]);
  }
  EXPECT_GT(error[1], 3.0 * error[0]);
  EXPECT_GT(stated[1], 1.5 * stated[0]);
  EXPECT_LT(error[1], stated[1]);
}

// A sheet whose red fades: a drift of luminance may be paint's, or shading's.
TEST(AlbedoLogStd, CountsWhatMayHaveDrifted) {
  Sheet sheet = MakeSheet(0.0);
  for (size_t k = 0; k < sheet.log_albedo.size(); ++k) {
    const double x = static_cast<double>(k / 3 % kSide) / kSide;
    sheet.log_albedo[k] += k % 3 == 0 ? 0.6 * x : -0.3 * x;
  }
  sheet.Observe(0.02);
  AlbedoFitOptions options, without;
  without.luminance_drifts = false;
  const std::vector<PaintedImage> image = {{&sheet.unpainted, &sheet.observed}};
  const double share = PaintShareOfDrift(image, sheet.neighbours, options);
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 1.0);
  EXPECT_EQ(0.0, PaintShareOfDrift(image, sheet.neighbours, without));
  const std::vector<double> before =
      AlbedoLogStd(image, sheet.neighbours, sheet.log_albedo, without);
  const std::vector<double> now = sheet.LogStd();
  const double shading = options.shading_std * options.shading_std;
  for (size_t i = 0; i < now.size(); ++i) {
    EXPECT_NEAR(before[i] * before[i] + share * shading, now[i] * now[i],
                kTolerance * now[i]);
  }
}

}  // namespace
}  // namespace ibrdf
