#include "ibrdf/metrics/illumination_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// Radiance is float, the floor shifts a factor by less than 1e-4 relative to
// maps whose darkest texel is 0.1 of the brightest.
constexpr double kMapFloorTolerance = 1e-4;
constexpr double kMapSumTolerance = 1e-12;

Image RandomMap(int width, int height, uint32_t seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> radiance(0.1f, 1.0f);
  Image map(width, height);
  for (float& v : map.rgb) v = radiance(rng);
  return map;
}

TEST(IlluminationMetrics, ScalesPerChannelAreAlignedAway) {
  Image reference = RandomMap(16, 8, 1);
  reference.rgb[0] = 1.0f;
  reference.rgb[1] = 0.1f;
  Image estimate = reference;
  const float scales[3] = {2.0f, 0.5f, 4.0f};
  for (size_t i = 0; i < estimate.rgb.size(); ++i) {
    estimate.rgb[i] *= scales[i % 3];
  }
  const double expected =
      std::sqrt((1 + 1 + 4) / 3.0) * std::log(2.0) / std::log(10.0);
  const IlluminationMetrics m =
      CompareIlluminations(estimate, reference).value();
  EXPECT_NEAR(expected, m.relative_log_rmse, kMapFloorTolerance);
  EXPECT_NEAR(expected, m.relative_log_rmse_unweighted, kMapFloorTolerance);
  EXPECT_NEAR(0.0, m.relative_log_rmse_aligned, kMapFloorTolerance);
}

// One wrong row of four: its share is its solid angle.
TEST(IlluminationMetrics, RowsCountBySolidAngle) {
  Image reference(8, 4);
  for (float& v : reference.rgb) v = 1.0f;
  reference.rgb.back() = 0.1f;
  Image estimate = reference;
  for (size_t i = 0; i < 8 * 3; ++i) estimate.rgb[i] = 3.0f;
  const double share = (1 - std::cos(kPi / 4)) / 2;
  const IlluminationMetrics m =
      CompareIlluminations(estimate, reference).value();
  const double relative = std::log(3.0) / std::log(10.0);
  EXPECT_NEAR(std::sqrt(share) * relative, m.relative_log_rmse,
              kMapFloorTolerance);
  EXPECT_NEAR(std::sqrt(share * (1 - share)) * relative,
              m.relative_log_rmse_aligned, kMapFloorTolerance);
  EXPECT_NEAR(std::sqrt(0.25) * relative, m.relative_log_rmse_unweighted,
              kMapFloorTolerance);
}

// The formula written down once more, with a hard sun, zeros and negatives.
TEST(IlluminationMetrics, MatchesASlowReference) {
  Image reference = RandomMap(12, 6, 2);
  const Image random = RandomMap(12, 6, 3);
  Image estimate = random;
  reference.At(3, 1)[0] = 1e6f;
  reference.At(4, 4)[1] = 0.0f;
  estimate.At(5, 5)[2] = -1.0f;
  const double floor = 1e-6 * 1e6;
  const double range = std::log(1e6 + floor) - std::log(floor);
  double sum = 0.0, weights = 0.0;
  for (int y = 0; y < 6; ++y) {
    const double w = std::cos(kPi * y / 6) - std::cos(kPi * (y + 1) / 6);
    for (int x = 0; x < 12; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double e = std::max(estimate.At(x, y)[c], 0.0f);
        const double r = reference.At(x, y)[c];
        const double d = std::log(e + floor) - std::log(r + floor);
        sum += w * d * d;
        weights += w;
      }
    }
  }
  const IlluminationMetrics m =
      CompareIlluminations(estimate, reference).value();
  EXPECT_NEAR(std::sqrt(sum / weights) / range, m.relative_log_rmse,
              kMapSumTolerance);
  EXPECT_LT(m.relative_log_rmse_aligned, m.relative_log_rmse);
}

TEST(IlluminationMetrics, BadMapsAreRefused) {
  const Image good = RandomMap(8, 4, 4);
  EXPECT_EQ("estimate: size: expected 8x4 as the reference, found 4x8",
            CompareIlluminations(RandomMap(4, 8, 5), good).status().message());
  EXPECT_FALSE(CompareIlluminations(Image(), Image()).ok());
  EXPECT_FALSE(CompareIlluminations(good, Image(8, 4)).ok());
  Image nan = good;
  nan.At(2, 3)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ("estimate: pixel (2, 3): expected finite radiance",
            CompareIlluminations(nan, good).status().message());
  EXPECT_EQ("reference: pixel (2, 3): expected finite radiance",
            CompareIlluminations(good, nan).status().message());
  // A black estimate is bad, not refused.
  EXPECT_GT(CompareIlluminations(Image(8, 4), good)->relative_log_rmse, 1.0);
}

}  // namespace
}  // namespace ibrdf
