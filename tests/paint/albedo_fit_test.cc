#include "ibrdf/solvers/paint/albedo_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "painted_ball.h"

namespace ibrdf {
namespace {

// A ball in paints under gloss, its shading off by an error that is smooth.
struct Painted {
  UnpaintedRadiance unpainted;
  std::vector<double> log_albedo, radiance;
  std::vector<NeighbourPair> neighbours;
};

Painted MakePainted(double shading_error) {
  ShadingLight light;
  light.strength = 1.5;
  const PaintedBall ball = MakePaintedBall(light);
  Painted out;
  out.log_albedo = ball.log_albedo;
  out.neighbours = NeighboursOf(ball.points, kBallWidth);
  for (size_t i = 0; i < ball.radiance.size(); ++i) {
    const ShadingPoint& point = ball.points[i / 3];
    out.unpainted.matte.push_back(ball.radiance[i] *
                                  std::exp(-ball.log_albedo[i]));
    out.unpainted.gloss.push_back(i / 3 % 50 == 0 ? 0.5 : 0.02);
    out.radiance.push_back(
        std::exp(shading_error * std::sin(3.0 * point.normal.x())) *
            ball.radiance[i] +
        out.unpainted.gloss.back());
  }
  return out;
}

std::vector<double> Fit(const Painted& p,
                        const AlbedoFitOptions& options = AlbedoFitOptions()) {
  const Observations observed = MakeObservations(p.radiance);
  return FitAlbedo({{&p.unpainted, &observed}}, p.neighbours, options);
}

double Rmse(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(FitAlbedo, FindsPaintUnderGloss) {
  const Painted p = MakePainted(0.0);
  const std::vector<double> found = Fit(p);
  EXPECT_LT(Rmse(found, p.log_albedo), 0.01);
  const std::vector<double> gain = PaintGain(p.unpainted, found);
  for (size_t i = 0; i < gain.size(); ++i) {
    EXPECT_NEAR(
        std::log(gain[i] * (p.unpainted.matte[i] + p.unpainted.gloss[i]) /
                 p.radiance[i]),
        0.0, 0.1);
  }
}

TEST(PaintGain, ShowsAnotherGloss) {
  const UnpaintedRadiance unpainted = {{2.0, 1.0}, {0.5, 0.25}};
  const std::vector<double> log_albedo = {std::log(0.5), std::log(3.0)};
  const std::vector<double> gain = PaintGain(unpainted, log_albedo, {0.1, 0.0});
  EXPECT_DOUBLE_EQ(1.1 / 2.5, gain[0]);
  EXPECT_DOUBLE_EQ(3.0 / 1.25, gain[1]);
  EXPECT_EQ(PaintGain(unpainted, log_albedo),
            PaintGain(unpainted, log_albedo, unpainted.gloss));
}

// What the shading lacks is not paint: it drifts, and like colours tell.
TEST(FitAlbedo, LeavesMostOfAnErrorOfShading) {
  const Painted p = MakePainted(0.2);
  double apparent = 0.0;
  for (size_t i = 0; i < p.radiance.size(); ++i) {
    const double a = std::log((p.radiance[i] - p.unpainted.gloss[i]) /
                              p.unpainted.matte[i]) -
                     p.log_albedo[i];
    apparent += a * a / static_cast<double>(p.radiance.size());
  }
  EXPECT_LT(Rmse(Fit(p), p.log_albedo), 0.5 * std::sqrt(apparent));
}

// A black letter on white has the white's chroma, and another luminance.
TEST(FitAlbedo, KeepsAPrintOfTheSameChroma) {
  Painted p = MakePainted(0.0);
  std::vector<size_t> letter;
  for (const NeighbourPair& pair : p.neighbours) {
    const size_t i = pair.first;
    const bool white = p.log_albedo[3 * i] == 0.1;
    if (white && i % 9 < 5 && (letter.empty() || letter.back() != i)) {
      letter.push_back(i);
    }
  }
  for (const size_t i : letter) {
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      p.log_albedo[k] -= 2.0;
      p.radiance[k] = std::exp(p.log_albedo[k]) * p.unpainted.matte[k] +
                      p.unpainted.gloss[k];
    }
  }
  const std::vector<double> found = Fit(p);
  double error = 0.0;
  for (const size_t i : letter) {
    error += std::abs(found[3 * i] - p.log_albedo[3 * i]) /
             static_cast<double>(letter.size());
  }
  EXPECT_GT(letter.size(), 100u);
  EXPECT_LT(error, 0.3);
}

// Black and white fields of one chroma, too large for their edges to tell the
// luminance of their middle: to draw both to what the chroma has on average
// would make both grey.
TEST(FitAlbedo, KeepsLargeFieldsOfOneChromaApart) {
  Painted p = MakePainted(0.2);
  for (size_t i = 0; i < p.radiance.size(); ++i) {
    const bool white = i < p.radiance.size() / 3;
    const double before = p.log_albedo[i];
    p.log_albedo[i] = white ? 0.0 : -1.6;
    p.radiance[i] =
        p.unpainted.gloss[i] + (p.radiance[i] - p.unpainted.gloss[i]) *
                                   std::exp(p.log_albedo[i] - before);
  }
  AlbedoFitOptions by_chroma;
  by_chroma.luminance_turns = 0;
  const double without = AlignedRmse(Fit(p, by_chroma), p.log_albedo);
  const double with = AlignedRmse(Fit(p), p.log_albedo);
  EXPECT_GT(without, 0.15);
  EXPECT_LT(with, 0.6 * without);
}

// Log albedo that fades over the ball: luminance with chroma, or alone.
Painted MakeFading(double chroma, double luminance) {
  Painted p = MakePainted(0.0);
  const Eigen::Array3d axis(0.7, 0.0, -0.7);
  for (size_t i = 0; i < p.radiance.size(); ++i) {
    const double x = static_cast<double>(i) / p.radiance.size() - 0.5;
    p.log_albedo[i] = chroma * std::sin(9.0 * x) * axis[i % 3] +
                      luminance * std::sin(7.0 * x);
    p.radiance[i] =
        std::exp(p.log_albedo[i]) * p.unpainted.matte[i] + p.unpainted.gloss[i];
  }
  return p;
}

// An apple's red fades in luminance as it does in chroma. A drift of luminance
// alone may be the shading's.
TEST(FitAlbedo, LuminanceDriftsAsFarAsChromaDoes) {
  AlbedoFitOptions by_colour;
  by_colour.luminance_drifts = false;
  const auto gain = [&](double chroma) {
    const Painted p = MakeFading(chroma, 0.4);
    return AlignedRmse(Fit(p), p.log_albedo) /
           AlignedRmse(Fit(p, by_colour), p.log_albedo);
  };
  EXPECT_LT(gain(0.5), 0.5);
  EXPECT_GT(gain(0.0), 0.95);
  EXPECT_LT(gain(0.0), 1.05);
}

// In each image a field is in a shadow that the render has not, another field
// in each: in one image it is a dark paint, in three the light's.
TEST(FitAlbedo, TakesNoShadowThatMovesForPaint) {
  const Painted lit = MakePainted(0.0);
  const AlbedoFitOptions options = UnderKnownShading();
  std::vector<Observations> observed;
  for (size_t k = 0; k < 3; ++k) {
    Painted shadowed = lit;
    const size_t points = lit.radiance.size() / 3;
    for (size_t i = k * points / 4; i < (k + 1) * points / 4; ++i) {
      for (size_t c = 3 * i; c < 3 * i + 3; ++c) shadowed.radiance[c] *= 0.3;
    }
    observed.push_back(MakeObservations(shadowed.radiance));
  }
  const auto error = [&](size_t count) {
    std::vector<PaintedImage> images;
    for (size_t k = 0; k < count; ++k) {
      images.push_back({&lit.unpainted, &observed[k]});
    }
    return AlignedRmse(FitAlbedo(images, lit.neighbours, options),
                       lit.log_albedo);
  };
  EXPECT_GT(error(1), 0.3);
  EXPECT_LT(error(2), 0.5 * error(1));
  EXPECT_LT(error(3), 0.1 * error(1));
}

// Nobody knows how bright, or of which colour, one light is beside another.
TEST(FitAlbedo, LevelAndHueOfAnImagesLightChangeNothing) {
  const Painted p = MakePainted(0.2);
  const Observations first = MakeObservations(p.radiance);
  UnpaintedRadiance dim = p.unpainted;
  const double scale[] = {0.5, 0.03, 0.125};
  for (size_t i = 0; i < p.radiance.size(); ++i) dim.matte[i] *= scale[i % 3];
  const std::vector<double> alone = Fit(p);
  const std::vector<double> twice =
      FitAlbedo({{&p.unpainted, &first}, {&dim, &first}}, p.neighbours,
                AlbedoFitOptions());
  EXPECT_LT(Rmse(alone, twice), 1e-4);
}

TEST(FitAlbedo, IsFiniteWhereNothingIsSeen) {
  Painted p = MakePainted(0.0);
  p.radiance[0] = -1.0;
  p.radiance[3] = 0.01;  // below the gloss
  p.unpainted.matte[6] = 0.0;
  p.unpainted.gloss[9] = 1e300;
  p.radiance[12] = 1e300;
  const std::vector<double> found = Fit(p);
  const std::vector<double> gain = PaintGain(p.unpainted, found);
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(std::isfinite(found[i])) << i;
    EXPECT_TRUE(gain[i] > 0.0 && std::isfinite(gain[i])) << i;
  }
}

}  // namespace
}  // namespace ibrdf
