#include "ibrdf/metrics/image_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace ibrdf {
namespace {

// Rounding of sums of differences of close numbers.
constexpr double kImageSumTolerance = 1e-10;
// The relative floor 1e-6 on values from 0.1 of the largest.
constexpr double kImageFloorTolerance = 1e-4;

Image RandomImage(int width, int height, uint32_t seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> radiance(0.1f, 1.0f);
  Image image(width, height);
  for (float& v : image.rgb) v = radiance(rng);
  return image;
}

Mask RandomMask(int width, int height, uint32_t seed) {
  std::mt19937 rng(seed);
  Mask mask(width, height, 0);
  for (uint8_t& v : mask.inside) v = rng() % 3 != 0 ? 255 : 0;
  return mask;
}

// SSIM pixel by pixel in two dimensions, from centred moments.
double SlowDssim(const Image& e, const Image& r, const Mask& mask) {
  double largest = 0.0, sum = 0.0;
  int64_t count = 0;
  const auto in = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < r.width && y < r.height &&
           mask.inside[size_t(y) * r.width + x] != 0;
  };
  for (int y = 0; y < r.height; ++y) {
    for (int x = 0; x < r.width; ++x) {
      for (int c = 0; c < 3 && in(x, y); ++c) {
        largest = std::max<double>(largest, r.At(x, y)[c]);
      }
    }
  }
  const double range = std::log(1 + largest);
  const double c1 = std::pow(0.01 * range, 2), c2 = std::pow(0.03 * range, 2);
  for (int y = 0; y < r.height; ++y) {
    for (int x = 0; x < r.width; ++x) {
      for (int c = 0; c < 3 && in(x, y); ++c) {
        double w = 0, ma = 0, mb = 0, va = 0, vb = 0, vab = 0;
        for (int moments = 1; moments <= 2; ++moments) {
          for (int v = y - 5; v <= y + 5; ++v) {
            for (int u = x - 5; u <= x + 5; ++u) {
              if (!in(u, v)) continue;
              const double g = std::exp(
                  -((u - x) * (u - x) + (v - y) * (v - y)) / (2 * 1.5 * 1.5));
              const double a = std::log(1.0 + e.At(u, v)[c]);
              const double b = std::log(1.0 + r.At(u, v)[c]);
              if (moments == 1) {
                w += g;
                ma += g * a;
                mb += g * b;
              } else {
                va += g * (a - ma) * (a - ma) / w;
                vb += g * (b - mb) * (b - mb) / w;
                vab += g * (a - ma) * (b - mb) / w;
              }
            }
          }
          if (moments == 1) {
            ma /= w;
            mb /= w;
          }
        }
        sum += (2 * ma * mb + c1) * (2 * vab + c2) /
               ((ma * ma + mb * mb + c1) * (va + vb + c2));
        ++count;
      }
    }
  }
  return (1 - sum / count) / 2;
}

TEST(ImageMetrics, SameImages) {
  const Image image = RandomImage(20, 15, 1);
  const ImageMetrics m = CompareImages(image, image, Mask()).value();
  EXPECT_EQ(0.0, m.log_rmse);
  EXPECT_NEAR(0.0, m.dssim, kImageSumTolerance);
  EXPECT_TRUE(std::isinf(m.psnr));
  EXPECT_EQ(300, m.pixels);
}

TEST(ImageMetrics, OneScaleChangesLogRmseButNotPsnr) {
  const Image reference = RandomImage(20, 15, 2);
  Image estimate = RandomImage(20, 15, 3);
  const double psnr = CompareImages(estimate, reference, Mask())->psnr;
  for (float& v : estimate.rgb) v *= 4.0f;
  EXPECT_NEAR(psnr, CompareImages(estimate, reference, Mask())->psnr,
              kImageSumTolerance);
  estimate = reference;
  for (float& v : estimate.rgb) v *= 4.0f;
  EXPECT_NEAR(std::log(4.0),
              CompareImages(estimate, reference, Mask())->log_rmse,
              kImageFloorTolerance);
  EXPECT_NEAR(std::log(4.0),
              CompareImages(estimate, reference, Mask())->mean_abs_log,
              kImageFloorTolerance);
}

TEST(ImageMetrics, PsnrInClosedForm) {
  Image reference(2, 1), estimate(2, 1);
  // e = (1, 1), r = (2, 0) in every channel: s = 1, error 1, peak 2.
  for (size_t c = 0; c < 3; ++c) {
    estimate.rgb[c] = estimate.rgb[3 + c] = 1.0f;
    reference.rgb[c] = 2.0f;
  }
  EXPECT_NEAR(20 * std::log10(2.0),
              CompareImages(estimate, reference, Mask())->psnr,
              kImageSumTolerance);
  // Nothing to scale: the error is the reference itself.
  EXPECT_NEAR(10 * std::log10(2.0),
              CompareImages(Image(2, 1), reference, Mask())->psnr,
              kImageSumTolerance);
}

TEST(ImageMetrics, DssimMatchesASlowReference) {
  const Image reference = RandomImage(23, 17, 4);
  Image estimate = RandomImage(23, 17, 5);
  for (size_t i = 0; i < estimate.rgb.size(); ++i) {
    estimate.rgb[i] = 0.7f * reference.rgb[i] + 0.3f * estimate.rgb[i];
  }
  for (const Mask& mask : {Mask(23, 17, 1), RandomMask(23, 17, 6)}) {
    const double slow = SlowDssim(estimate, reference, mask);
    EXPECT_GT(slow, 0.001);
    EXPECT_NEAR(slow, CompareImages(estimate, reference, mask)->dssim,
                kImageSumTolerance);
  }
}

TEST(ImageMetrics, NothingOutsideTheMaskMatters) {
  const Image reference = RandomImage(16, 16, 7);
  const Image estimate = RandomImage(16, 16, 8);
  Mask mask = RandomMask(16, 16, 9);
  const ImageMetrics before = CompareImages(estimate, reference, mask).value();
  EXPECT_EQ(static_cast<int64_t>(mask.CountInside()), before.pixels);
  Image changed = estimate, changed_reference = reference;
  for (size_t i = 0; i < mask.inside.size(); ++i) {
    if (mask.inside[i] != 0) continue;
    changed.rgb[3 * i] = std::numeric_limits<float>::quiet_NaN();
    changed_reference.rgb[3 * i + 1] = 1e30f;
  }
  const ImageMetrics after =
      CompareImages(changed, changed_reference, mask).value();
  EXPECT_EQ(before.log_rmse, after.log_rmse);
  EXPECT_EQ(before.psnr, after.psnr);
  EXPECT_EQ(before.dssim, after.dssim);
}

TEST(ImageMetrics, ReferencePixelsThatAreNotFiniteAreLeftOut) {
  Image reference = RandomImage(8, 8, 10);
  const Image estimate = RandomImage(8, 8, 11);
  Mask mask(8, 8, 1);
  mask.inside[9] = 0;
  const ImageMetrics masked = CompareImages(estimate, reference, mask).value();
  reference.rgb[9 * 3 + 1] = std::numeric_limits<float>::infinity();
  const ImageMetrics m = CompareImages(estimate, reference, Mask()).value();
  EXPECT_EQ(63, m.pixels);
  EXPECT_EQ(masked.log_rmse, m.log_rmse);
  EXPECT_EQ(masked.dssim, m.dssim);
}

TEST(ImageMetrics, BadImagesAreRefused) {
  const Image good = RandomImage(4, 3, 12);
  EXPECT_EQ("estimate: size: expected 4x3 as the reference, found 3x4",
            CompareImages(Image(3, 4), good, Mask()).status().message());
  EXPECT_EQ("mask: size: expected 4x3 as the reference, found 2x2",
            CompareImages(good, good, Mask(2, 2, 1)).status().message());
  EXPECT_FALSE(CompareImages(good, good, Mask(4, 3, 0)).ok());
  EXPECT_FALSE(CompareImages(good, Image(4, 3), Mask()).ok());
  EXPECT_FALSE(CompareImages(Image(), Image(), Mask()).ok());
  Image nan = good;
  nan.rgb[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ("estimate: pixel (1, 0): expected finite radiance",
            CompareImages(nan, good, Mask()).status().message());
}

}  // namespace
}  // namespace ibrdf
