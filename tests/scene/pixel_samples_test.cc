#include "ibrdf/scene/pixel_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace ibrdf {
namespace {

Image FromLog(int width, int height,
              const std::function<double(double, double)>& log_radiance) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        image.At(x, y)[c] =
            static_cast<float>(std::exp(log_radiance(x + 0.5, y + 0.5)));
      }
    }
  }
  return image;
}

// |log centre - log mean| of pixels inside the mask.
double TrueError(const std::function<double(double, double)>& log_radiance,
                 int x, int y) {
  constexpr int kSide = 32;
  double mean = 0.0;
  for (int k = 0; k < kSide * kSide; ++k) {
    mean += std::exp(log_radiance(x + (k % kSide + 0.5) / kSide,
                                  y + (k / kSide + 0.5) / kSide)) /
            (kSide * kSide);
  }
  return std::abs(std::log(mean) - log_radiance(x + 0.5, y + 0.5));
}

TEST(PixelSamples, NothingIsExpectedOfAnEvenOrSteadilyRisingImage) {
  const Image rising =
      FromLog(9, 7, [](double x, double y) { return 0.01 * x - 0.02 * y; });
  const Mask all(9, 7, 255);
  const std::vector<double> errors = CentreErrors(rising, all);
  // At the limb a rise is taken for a bend.
  for (int y = 2; y < 5; ++y) {
    for (int x = 2; x < 7; ++x) EXPECT_NEAR(0.0, errors[y * 9 + x], 1e-6);
  }
  const Image even = FromLog(9, 7, [](double, double) { return -3.0; });
  EXPECT_TRUE(PixelsToSample(even, all, 1e-4).empty());
}

// The images are waves, from long ones to some shorter than a pixel, and a hard
// edge across it.
TEST(PixelSamples, MeanErrorIsBoundedAndNotFarFromTheTruth) {
  constexpr int kSize = 40;
  const Mask all(kSize, kSize, 255);
  const auto ratio =
      [&](const std::function<double(double, double)>& log_radiance) {
        const Image image = FromLog(kSize, kSize, log_radiance);
        const std::vector<double> expected = CentreErrors(image, all);
        double sum = 0.0, truth = 0.0;
        for (int k = 0; k < kSize * kSize; ++k) {
          sum += expected[k];
          truth += TrueError(log_radiance, k % kSize, k / kSize);
        }
        return sum / truth;
      };
  for (const double wavelength : {20.0, 8.0, 4.0, 1.3}) {
    const double r = ratio([wavelength](double x, double y) {
      return 0.5 * std::sin(2 * 3.14159 * (x + 0.6 * y) / wavelength);
    });
    EXPECT_GT(r, 0.8) << wavelength;
    EXPECT_LT(r, 8.0) << wavelength;
  }
  const double edge =
      ratio([](double x, double y) { return x + 0.37 * y > 23.0 ? 1.0 : 0.0; });
  EXPECT_GT(edge, 1.0);
  EXPECT_LT(edge, 8.0);
}

TEST(PixelSamples, FewestPixelsThatMeetTheError) {
  const Image image = FromLog(
      30, 20, [](double x, double y) { return std::sin(0.02 * x * y); });
  Mask mask(30, 20, 255);
  for (int x = 0; x < 30; ++x) mask.inside[5 * 30 + x] = 0;
  const std::vector<double> errors = CentreErrors(image, mask);
  const double allowed = 0.01;
  const Mask chosen = PixelsToSample(image, mask, allowed);
  ASSERT_FALSE(chosen.empty());
  double left = 0.0, least = 1e9, largest_left = 0.0;
  for (size_t k = 0; k < errors.size(); ++k) {
    if (mask.inside[k] == 0) {
      EXPECT_EQ(0.0, errors[k]);
      EXPECT_EQ(0, chosen.inside[k]);
    }
    if (chosen.inside[k] != 0) {
      least = std::min(least, errors[k]);
    } else {
      left += errors[k];
      largest_left = std::max(largest_left, errors[k]);
    }
  }
  const auto pixels = static_cast<double>(mask.CountInside());
  EXPECT_LE(left / pixels, allowed);
  EXPECT_GT((left + least) / pixels, allowed);
  EXPECT_LE(largest_left, least);
}

TEST(PixelSamples, ScaleDoesNotMatterAndBlackIsNothing) {
  Image image = FromLog(12, 12, [](double x, double y) {
    return std::sin(x) * std::cos(1.7 * y);
  });
  image.At(3, 4)[1] = 0.0f;
  const Mask all(12, 12, 255);
  const std::vector<double> errors = CentreErrors(image, all);
  for (const double e : errors) EXPECT_TRUE(std::isfinite(e));
  for (float& v : image.rgb) v *= 1024.0f;
  const std::vector<double> scaled = CentreErrors(image, all);
  for (size_t k = 0; k < errors.size(); ++k) {
    EXPECT_NEAR(errors[k], scaled[k], 1e-9);
  }
  EXPECT_TRUE(PixelsToSample(Image(12, 12), all, 1e-6).empty());
  EXPECT_TRUE(PixelsToSample(image, Mask(12, 12, 0), 1e-6).empty());
}

}  // namespace
}  // namespace ibrdf
