#include "ibrdf/metrics/albedo_map_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

Image Paint(int size) {
  Image image(size, size);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = 0.2f + 0.5f * static_cast<float>((7 * (i / 3 / 5) + i) % 3);
  }
  return image;
}

TEST(AlbedoMapMetrics, AScalePerChannelIsLeftOut) {
  const Image reference = Paint(40);
  Image estimate = reference;
  const float scales[] = {0.5f, 2.0f, 3.0f};
  for (size_t i = 0; i < estimate.rgb.size(); ++i) {
    estimate.rgb[i] *= scales[i % 3];
  }
  const AlbedoMapMetrics m =
      CompareAlbedoMaps(estimate, reference, Mask()).value();
  const double squares = std::pow(std::log(0.5), 2) +
                         std::pow(std::log(2.0), 2) +
                         std::pow(std::log(3.0), 2);
  EXPECT_NEAR(std::sqrt(squares / 3.0), m.log_rmse, 1e-6);
  EXPECT_NEAR(0.0, m.log_rmse_aligned, 1e-5);
  EXPECT_NEAR(0.0, m.lmse, 1e-9);
  EXPECT_NEAR(0.0, m.dssim, 1e-6);
  EXPECT_EQ(1600, m.pixels);
}

// By hand: of two pixels (1, 1) and an estimate (1, 2), the best scale is 3/5.
TEST(AlbedoMapMetrics, LocalErrorIsThatOfTheBestScale) {
  Image reference(2, 1), estimate(2, 1);
  for (float& v : reference.rgb) v = 1.0f;
  for (int c = 0; c < 3; ++c) {
    estimate.At(0, 0)[c] = 1.0f;
    estimate.At(1, 0)[c] = 2.0f;
  }
  const AlbedoMapMetrics m =
      CompareAlbedoMaps(estimate, reference, Mask()).value();
  EXPECT_NEAR((0.4 * 0.4 + 0.2 * 0.2) / 2.0, m.lmse, 1e-6);
  EXPECT_NEAR(0.5 * std::log(2.0), m.log_rmse_aligned, 1e-6);
}

TEST(AlbedoMapMetrics, TakesPixelsThatBothHave) {
  const Image reference = Paint(8);
  Image estimate = reference;
  estimate.At(0, 0)[1] = 0.0f;
  estimate.At(1, 0)[2] = std::numeric_limits<float>::quiet_NaN();
  estimate.At(2, 0)[0] = 50.0f;
  Mask mask(8, 8, 1);
  mask.inside[2] = 0;
  const AlbedoMapMetrics m =
      CompareAlbedoMaps(estimate, reference, mask).value();
  EXPECT_EQ(61, m.pixels);
  EXPECT_NEAR(0.0, m.log_rmse, 1e-6);
}

TEST(AlbedoMapMetrics, RefusesWhatCannotBeCompared) {
  const Image reference = Paint(8);
  EXPECT_EQ("estimate: size: expected 8x8 as the reference, found 4x4",
            CompareAlbedoMaps(Paint(4), reference, Mask()).status().message());
  EXPECT_EQ("mask: size: expected 8x8 as the reference, found 4x4",
            CompareAlbedoMaps(reference, reference, Mask(4, 4, 1))
                .status()
                .message());
  EXPECT_FALSE(CompareAlbedoMaps(Image(8, 8), reference, Mask()).ok());
}

}  // namespace
}  // namespace ibrdf
