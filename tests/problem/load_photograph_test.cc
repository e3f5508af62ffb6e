#include "ibrdf/solvers/problem/load_photograph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/png.h"
#include "tests/support/photo_files.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A row of grey pixels of 8 or 16 bits.
std::string GreyPng(const std::vector<int>& codes, int bits) {
  PngSpec png;
  png.width = static_cast<int>(codes.size());
  png.height = 1;
  png.bits = bits;
  png.type = PNG_COLOR_TYPE_GRAY;
  for (const int code : codes) {
    png.rows += BigEndianBytes(static_cast<uint32_t>(code), bits / 8);
  }
  return PngBytes(png);
}

class LoadPhotographTest : public ::testing::Test {
 protected:
  ImageSpec Spec(const std::string& name, const std::string& bytes) const {
    WriteBytes(dir_.File(name), bytes);
    ImageSpec spec;
    spec.file = dir_.File(name);
    return spec;
  }
  ImageSpec Spec(const Image& image) const {
    EXPECT_TRUE(WriteExr(image, dir_.File("a.exr")).ok());
    ImageSpec spec;
    spec.file = dir_.File("a.exr");
    return spec;
  }

  const TempDir dir_;
};

bool AnySays(const std::vector<std::string>& warnings,
             const std::string& word) {
  for (const std::string& w : warnings) {
    if (w.find(word) != std::string::npos) return true;
  }
  return false;
}

// IEC 61966-2-1, written out.
double FromSrgb(double y) {
  return y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
}

TEST_F(LoadPhotographTest, FloatsKeepTheirBits) {
  Image image(16, 16);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = std::exp(std::sin(0.37f * static_cast<float>(i)));
  }
  image.rgb[5] = 3e38f;
  image.rgb[7] = 1e-40f;
  const StatusOr<Photograph> found = LoadPhotograph(Spec(image));
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_EQ(image.rgb, found->radiance.rgb);
  EXPECT_FALSE(found->bounds.has_value());
  EXPECT_TRUE(found->mask.empty());
  EXPECT_TRUE(found->warnings.empty());
}

TEST_F(LoadPhotographTest, EightBitsThatSayNothingAreSrgbAndItIsSaid) {
  const StatusOr<Photograph> found =
      LoadPhotograph(Spec("a.png", GreyPng({0, 1, 10, 128, 254, 255}, 8)));
  ASSERT_TRUE(found.ok()) << found.status().message();
  // Black has an upper end alone, and stands for it; white a lower one.
  EXPECT_EQ(0.0f, *found->bounds->low.At(0, 0));
  EXPECT_NEAR(FromSrgb(0.5 / 255.0), *found->radiance.At(0, 0), 1e-8);
  EXPECT_EQ(*found->bounds->high.At(0, 0), *found->radiance.At(0, 0));
  EXPECT_TRUE(std::isinf(*found->bounds->high.At(5, 0)));
  EXPECT_NEAR(FromSrgb(254.5 / 255.0), *found->radiance.At(5, 0), 1e-6);
  for (const auto& [x, code] : {std::pair(1, 1), {2, 10}, {3, 128}, {4, 254}}) {
    EXPECT_NEAR(FromSrgb(code / 255.0), *found->radiance.At(x, 0), 1e-6);
  }
  EXPECT_NEAR(FromSrgb(127.5 / 255.0), *found->bounds->low.At(3, 0), 1e-6);
  EXPECT_NEAR(FromSrgb(128.5 / 255.0), *found->bounds->high.At(3, 0), 1e-6);
  EXPECT_TRUE(AnySays(found->warnings, "sRGB is assumed"));
  EXPECT_TRUE(AnySays(found->warnings, "17 % of the object's values are clip"));
}

TEST_F(LoadPhotographTest, WhatIsSaidGoesBeforeTheFile) {
  ImageSpec spec = Spec("a.png", GreyPng({100, 200, 230}, 8));
  spec.response = ResponseChoice::kPower;
  spec.response_parameter = 2.0;
  spec.white = 220.0;
  spec.black = 20.0;
  spec.exposure = 4.0;
  const StatusOr<Photograph> found = LoadPhotograph(spec);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_NEAR(0.16 / 4, *found->radiance.At(0, 0), 1e-7);
  EXPECT_NEAR(0.81 / 4, *found->radiance.At(1, 0), 1e-7);
  EXPECT_TRUE(std::isinf(*found->bounds->high.At(2, 0)));
  EXPECT_FALSE(AnySays(found->warnings, "assumed"));
}

TEST_F(LoadPhotographTest, SixteenBitsMustSayWhatTheyAre) {
  ImageSpec spec = Spec("a.png", GreyPng({1000, 32768}, 16));
  const Status refused = LoadPhotograph(spec).status();
  EXPECT_EQ(StatusCode::kInvalidInput, refused.code());
  EXPECT_NE(std::string::npos, refused.message().find("image.response"));
  EXPECT_NE(std::string::npos, refused.message().find("a.png"));
  spec.response = ResponseChoice::kLinear;
  const StatusOr<Photograph> found = LoadPhotograph(spec);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_NEAR(1000 / 65535.0, *found->radiance.At(0, 0), 1e-7);
}

TEST_F(LoadPhotographTest, FloatsThroughACurve) {
  Image image(2, 1);
  image.rgb.assign(6, 0.5f);
  ImageSpec spec = Spec(image);
  spec.response = ResponseChoice::kSrgb;
  const StatusOr<Photograph> found = LoadPhotograph(spec);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_NEAR(FromSrgb(0.5), *found->radiance.At(0, 0), 1e-6);
  spec.white = 200.0;
  EXPECT_EQ(StatusCode::kInvalidInput, LoadPhotograph(spec).status().code());
  spec.white.reset();
  spec.response = ResponseChoice::kUnknown;
  const Status refused = LoadPhotograph(spec).status();
  EXPECT_EQ(StatusCode::kInvalidInput, refused.code());
  EXPECT_NE(std::string::npos, refused.message().find("image.response"));
}

TEST_F(LoadPhotographTest, BracketsNarrowWhatIsKnown) {
  // sRGB codes of radiance 0.02, 0.3 and 6 at exposures 1, 0.1 and 10.
  const std::vector<double> truth = {0.02, 0.3, 6.0};
  ResponseDefinition srgb;
  srgb.kind = ResponseKind::kSrgb;
  const auto codes = [&](double exposure) {
    std::vector<int> out;
    for (const double x : truth) {
      out.push_back(static_cast<int>(std::lround(
          255.0 * std::min(ResponseCurve(srgb).Encode(exposure * x), 1.0))));
    }
    return out;
  };
  ImageSpec spec = Spec("a.png", GreyPng(codes(1.0), 8));
  const StatusOr<Photograph> alone = LoadPhotograph(spec);
  for (const auto& [name, exposure] :
       {std::pair("b.png", 0.1), {"c.png", 10.0}}) {
    spec.brackets.push_back(Spec(name, GreyPng(codes(exposure), 8)).file);
    spec.bracket_exposures.push_back(exposure);
  }
  const StatusOr<Photograph> found = LoadPhotograph(spec);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_TRUE(std::isinf(*alone->bounds->high.At(2, 0)));
  for (int x = 0; x < 3; ++x) {
    const double low = *found->bounds->low.At(x, 0);
    const double high = *found->bounds->high.At(x, 0);
    EXPECT_LE(low, truth[x]);
    EXPECT_GE(high, truth[x]);
    EXPECT_LT(high / low, 1.1);
    EXPECT_LE(high, *alone->bounds->high.At(x, 0));
    EXPECT_GE(low, *alone->bounds->low.At(x, 0));
    EXPECT_NEAR(std::sqrt(low * high), *found->radiance.At(x, 0), 1e-6 * high);
  }
  EXPECT_FALSE(AnySays(found->warnings, "contradict"));
  // Another exposure than it was.
  spec.bracket_exposures[0] = 0.2;
  EXPECT_TRUE(AnySays(LoadPhotograph(spec)->warnings, "contradict"));
}

TEST_F(LoadPhotographTest, BracketsOfOtherSizesOrKindsAreRefused) {
  ImageSpec spec = Spec("a.png", GreyPng({0, 100, 255}, 8));
  spec.bracket_exposures = {4.0};
  spec.brackets = {Spec("b.png", GreyPng({0, 100}, 8)).file};
  Status refused = LoadPhotograph(spec).status();
  EXPECT_EQ(StatusCode::kInvalidInput, refused.code());
  EXPECT_NE(std::string::npos, refused.message().find("b.png"));
  spec.brackets = {Spec(Image(3, 1)).file};
  EXPECT_EQ(StatusCode::kInvalidInput, LoadPhotograph(spec).status().code());
  ImageSpec floats = Spec(Image(3, 1));
  floats.bracket_exposures = {4.0};
  floats.brackets = {Spec("c.png", GreyPng({0, 100, 255}, 8)).file};
  refused = LoadPhotograph(floats).status();
  EXPECT_NE(std::string::npos, refused.message().find("image.brackets"));
}

TEST_F(LoadPhotographTest, AnUnknownCurveKeepsTheCodes) {
  ImageSpec spec = Spec("a.png", GreyPng({0, 100, 255}, 8));
  spec.response = ResponseChoice::kUnknownAces;
  const StatusOr<Photograph> found = LoadPhotograph(spec);
  ASSERT_TRUE(found.ok()) << found.status().message();
  ASSERT_TRUE(found->unknown_curve.has_value());
  EXPECT_EQ(100.0f, *found->unknown_curve->codes.At(1, 0));
  ASSERT_EQ(1u, found->unknown_curve->families.size());
  EXPECT_EQ(ResponseKind::kAces, found->unknown_curve->families[0].kind);
  EXPECT_TRUE(found->bounds.has_value());
}

TEST_F(LoadPhotographTest, MasksOfAnotherSizeNameBoth) {
  ImageSpec spec = Spec("a.png", GreyPng({1, 2, 3}, 8));
  WriteBytes(dir_.File("m.png"), GreyPng({255, 255}, 8));
  spec.mask = dir_.File("m.png");
  const Status status = LoadPhotograph(spec).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("3x1, found 2x1"));
}

TEST(DoubtfulValues, SaturatedFloatsAreToldFromEvenOnes) {
  Image image(20, 20);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = 0.1f + 1.3f * static_cast<float>(i) / 1200.0f;
  }
  EXPECT_TRUE(DoubtfulValues(image, Mask()).empty());
  for (float& v : image.rgb) v = std::min(v, 1.1f);
  const std::vector<std::string> doubts = DoubtfulValues(image, Mask());
  ASSERT_EQ(size_t{1}, doubts.size());
  EXPECT_NE(std::string::npos, doubts[0].find("23 %")) << doubts[0];
  // Outside the mask they do not matter.
  Mask mask(20, 20, 0);
  for (size_t i = 0; i < 200; ++i) mask.inside[i] = 255;
  EXPECT_TRUE(DoubtfulValues(image, mask).empty());
  image.rgb.assign(image.rgb.size(), 0.7f);
  EXPECT_TRUE(DoubtfulValues(image, Mask()).empty());
}

TEST(DoubtfulValues, CodesInAFileOfFloats) {
  Image image(20, 20);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = static_cast<float>(1 + i % 254) / 255.0f;
  }
  EXPECT_TRUE(AnySays(DoubtfulValues(image, Mask()), "1/255"));
  for (float& v : image.rgb) v *= 1.01f;
  EXPECT_TRUE(DoubtfulValues(image, Mask()).empty());
}

}  // namespace
}  // namespace ibrdf
