#include "ibrdf/solvers/paint/albedo_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ibrdf {
namespace {

constexpr int kPoints = 600;
constexpr double kPaint[3][3] = {
    {0.3, -0.8, -1.0}, {-1.2, -0.6, 0.1}, {0.2, 0.1, -0.3}};

// A ball's row of points in three paints under gloss.
struct Painted {
  UnpaintedRadiance unpainted;
  std::vector<double> log_albedo, radiance;
};

Painted MakePainted(double shading_error) {
  Painted out;
  for (int i = 0; i < kPoints; ++i) {
    for (int c = 0; c < 3; ++c) {
      out.unpainted.matte.push_back(0.4 + 0.3 * std::sin(0.01 * i));
      out.unpainted.gloss.push_back(i % 50 == 0 ? 0.5 : 0.02);
      out.log_albedo.push_back(kPaint[i / 7 % 3][c]);
      out.radiance.push_back(
          std::exp(out.log_albedo.back() + shading_error * std::sin(0.05 * i)) *
              out.unpainted.matte.back() +
          out.unpainted.gloss.back());
    }
  }
  return out;
}

double Rmse(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(FitAlbedo, FindsPaintUnderGloss) {
  const Painted p = MakePainted(0.0);
  const std::vector<double> found =
      FitAlbedo(p.unpainted, MakeObservations(p.radiance), {});
  EXPECT_LT(Rmse(found, p.log_albedo), 1e-6);
  const std::vector<double> gain = PaintGain(p.unpainted, found);
  for (size_t i = 0; i < gain.size(); ++i) {
    EXPECT_NEAR(gain[i] * (p.unpainted.matte[i] + p.unpainted.gloss[i]),
                p.radiance[i], 1e-6);
  }
}

// What the shading lacks is not paint, as far as like colours tell.
TEST(FitAlbedo, LeavesMostOfAnErrorOfShading) {
  const Painted p = MakePainted(0.1);
  const std::vector<double> found =
      FitAlbedo(p.unpainted, MakeObservations(p.radiance), {});
  EXPECT_LT(Rmse(found, p.log_albedo), 0.6 * 0.1 / std::sqrt(2.0));
}

// A black letter on white has the white's chroma, and another luminance.
TEST(FitAlbedo, KeepsAPrintOfTheSameChroma) {
  Painted p = MakePainted(0.0);
  for (int i = 100; i < 110; ++i) {
    for (int c = 0; c < 3; ++c) {
      const size_t k = 3 * i + c;
      p.log_albedo[k] -= 2.0;
      p.radiance[k] = std::exp(p.log_albedo[k]) * p.unpainted.matte[k] +
                      p.unpainted.gloss[k];
    }
  }
  const std::vector<double> found =
      FitAlbedo(p.unpainted, MakeObservations(p.radiance), {});
  for (int i = 300; i < 330; ++i) {
    EXPECT_NEAR(found[i], p.log_albedo[i], 0.1) << i;
  }
}

TEST(FitAlbedo, IsFiniteWhereNothingIsSeen) {
  Painted p = MakePainted(0.0);
  p.radiance[0] = -1.0;
  p.radiance[3] = 0.01;  // below the gloss
  p.unpainted.matte[6] = 0.0;
  p.unpainted.gloss[9] = 1e300;
  p.radiance[12] = 1e300;
  const std::vector<double> found =
      FitAlbedo(p.unpainted, MakeObservations(p.radiance), {});
  const std::vector<double> gain = PaintGain(p.unpainted, found);
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(std::isfinite(found[i])) << i;
    EXPECT_TRUE(gain[i] > 0.0 && std::isfinite(gain[i])) << i;
  }
}

}  // namespace
}  // namespace ibrdf
