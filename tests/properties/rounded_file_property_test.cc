// What is written with fewer bits is read back within half a step.
#include <gtest/gtest.h>
#include <png.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/radiance_hdr.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/report/preview.h"
#include "tests/properties/generators.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Pixels of any bits, of ordinary radiance, or runs of one pixel: both codings
// of a scanline, and lengths where either changes.
Image AnyImage() {
  const int width = *rc::gen::oneOf(rc::gen::element(1, 7, 8, 127, 128, 260),
                                    rc::gen::inRange(1, 40));
  Image image(width, *rc::gen::inRange(1, 12));
  const int kind = *Choice(3);
  if (kind == 0) {
    image.rgb = AnyFloats(image.rgb.size());
    return image;
  }
  std::mt19937_64 rng(*rc::gen::arbitrary<uint64_t>());
  std::uniform_real_distribution<float> log2(-6.0f, 6.0f);
  // All that a float holds, or a half.
  const auto middle = static_cast<float>(*Choice(2) == 0 ? *Choice(278) - 150
                                                         : *Choice(44) - 26);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    const bool run = kind == 2 && i >= 3 && rng() % 8 != 0;
    image.rgb[i] = run ? image.rgb[i - 3] : std::exp2(middle + log2(rng));
  }
  return image;
}

double Within(double x, double most) { return std::clamp(x, -most, most); }

// Half: 11 bits of mantissa down to 2^-14, steps of 2^-24 below.
RC_GTEST_PROP(RoundedFileProperty, HalfExrIsWithinHalfAStep, ()) {
  const TempDir dir;
  const Image image = AnyImage();
  const std::string path = dir.File("a.exr");
  RC_ASSERT(WriteExr(image, path, ExrPixelType::kHalf).ok());
  const StatusOr<Image> back = ReadExr(path);
  RC_ASSERT(back.ok());
  RC_ASSERT(back->width == image.width && back->height == image.height);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    const float v = image.rgb[i], w = back->rgb[i];
    if (!std::isfinite(v)) {
      RC_ASSERT((std::isnan(v) ? std::isnan(w) : v == w));
      continue;
    }
    const double held = Within(v, 65504.0);
    RC_ASSERT(std::abs(w - held) <=
              std::max(std::ldexp(std::abs(held), -11), std::ldexp(1.0, -25)));
  }
  // What the file holds is kept from then on.
  RC_ASSERT(WriteExr(*back, path, ExrPixelType::kHalf).ok());
  const StatusOr<Image> again = ReadExr(path);
  RC_ASSERT(again.ok());
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    RC_ASSERT(again->rgb[i] == back->rgb[i] || std::isnan(back->rgb[i]));
  }
}

// A step is 2^(e - 8). The largest channel m of a pixel lies in [2^(e - 1),
// 2^e), or within half a step below: where it would round up to 256 the next e
// is taken. So m >= 127.75 steps, and half a step is at most m / 255.5.
RC_GTEST_PROP(RoundedFileProperty, RadianceHdrIsWithinHalfAStep, ()) {
  const TempDir dir;
  const Image image = AnyImage();
  const std::string path = dir.File("a.hdr");
  RC_ASSERT(WriteRadianceHdr(image, path).ok());
  const StatusOr<Image> back = ReadRadianceHdr(path);
  RC_ASSERT(back.ok());
  RC_ASSERT(back->width == image.width && back->height == image.height);
  const double most = std::ldexp(255.0, 119), least = std::ldexp(1.0, -128);
  for (size_t pixel = 0; pixel < image.num_pixels(); ++pixel) {
    double held[3], largest = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double v = image.rgb[3 * pixel + c];
      held[c] = v > 0.0 ? std::min(v, most) : 0.0;  // not a number is 0
      largest = std::max(largest, held[c]);
    }
    for (int c = 0; c < 3; ++c) {
      RC_ASSERT(std::abs(back->rgb[3 * pixel + c] - held[c]) <=
                std::max(largest / 255.5, least));
    }
  }
  const std::string bytes = ReadBytes(path);
  RC_ASSERT(WriteRadianceHdr(*back, path).ok());
  RC_ASSERT(ReadBytes(path) == bytes);
}

// By libpng's own reader: of 8-bit RGB files io reads masks alone.
Rgb8Image ReadPng(const std::string& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  RC_ASSERT(
      png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) != 0);
  png.format = PNG_FORMAT_RGB;
  Rgb8Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  RC_ASSERT(PNG_IMAGE_SIZE(png) == image.rgb.size());
  RC_ASSERT(
      png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) != 0);
  return image;
}

RC_GTEST_PROP(RoundedFileProperty, PngKeepsEveryByteAndItsMask, ()) {
  const TempDir dir;
  Rgb8Image image(*rc::gen::inRange(1, 70), *rc::gen::inRange(1, 70));
  std::mt19937_64 rng(*rc::gen::arbitrary<uint64_t>());
  const unsigned zeros = *rc::gen::inRange(1u, 4u);
  for (uint8_t& v : image.rgb) {
    v = rng() % zeros == 0 ? static_cast<uint8_t>(rng() >> 56) : 0;
  }
  const std::string path = dir.File("a.png");
  RC_ASSERT(WritePng(image, path).ok());
  const Rgb8Image back = ReadPng(ReadBytes(path));
  RC_ASSERT(back.width == image.width && back.height == image.height);
  RC_ASSERT(back.rgb == image.rgb);
  const StatusOr<Mask> mask = ReadMask(path);
  RC_ASSERT(mask.ok());
  RC_ASSERT(mask->width == image.width && mask->height == image.height);
  for (size_t i = 0; i < mask->inside.size(); ++i) {
    const uint8_t* v = &image.rgb[3 * i];
    RC_ASSERT((mask->inside[i] != 0) == (v[0] != 0 || v[1] != 0 || v[2] != 0));
  }
}

// The radiance that a preview's pixel stands for is that of the picture within
// half a code of the sRGB curve, and what is out of [0, 1] within its ends.
RC_GTEST_PROP(RoundedFileProperty, PreviewIsWithinHalfACode, ()) {
  PreviewPanel panel;
  panel.image = AnyImage();
  panel.exposure = *Magnitude(1e-6, 1e6);
  const int side = std::max(panel.image.width, panel.image.height);
  const StatusOr<std::string> png = EncodePng(DrawPanel(panel, side).pixels);
  RC_ASSERT(png.ok());
  const Rgb8Image back = ReadPng(*png);
  RC_ASSERT(back.width == panel.image.width);
  RC_ASSERT(back.height == panel.image.height);
  for (size_t i = 0; i < panel.image.num_pixels(); ++i) {
    const float* rgb = &panel.image.rgb[3 * i];
    // Grey, as is inf - inf.
    if (std::isnan(rgb[0] + rgb[1] + rgb[2])) continue;
    for (int c = 0; c < 3; ++c) {
      const double shown = std::clamp(rgb[c] * panel.exposure, 0.0, 1.0);
      const double code = back.rgb[3 * i + c];
      // The picture is of floats; the curve's published pieces leave 1e-8.
      const double rounding = std::ldexp(shown, -23) + 1e-8;
      RC_ASSERT(shown >= DecodeSrgb((code - 0.5) / 255.0) - rounding);
      RC_ASSERT(shown <= DecodeSrgb((code + 0.5) / 255.0) + rounding);
    }
  }
}

TEST(RoundedFileProperty, EverySrgbCodeComesBack) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(code, EncodeSrgb(DecodeSrgb(code / 255.0)));
  }
}

}  // namespace
}  // namespace ibrdf
