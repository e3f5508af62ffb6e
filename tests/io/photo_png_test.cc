// PNG photographs: every kind of pixel, what they say of their curve, damage.
#include <gtest/gtest.h>

#include <numeric>

#include "ibrdf/io/photo_file.h"
#include "tests/support/corruption.h"
#include "tests/support/photo_files.h"

namespace ibrdf {
namespace {

// Bytes 0, 1, 2, ... of rows.
std::string Ramp(size_t bytes) {
  std::string rows(bytes, '\0');
  std::iota(rows.begin(), rows.end(), '\0');
  return rows;
}

PngSpec Rgb8(int width = 3, int height = 2) {
  PngSpec spec;
  spec.width = width;
  spec.height = height;
  spec.rows = Ramp(static_cast<size_t>(3 * width * height));
  return spec;
}

Photo Read(const PngSpec& spec) {
  const StatusOr<Photo> photo = DecodePhoto("a.png", PngBytes(spec));
  EXPECT_TRUE(photo.ok()) << photo.status().message();
  return photo.ok() ? *photo : Photo();
}

std::vector<float> RedOf(const Photo& photo) {
  std::vector<float> values;
  for (size_t i = 0; i < photo.image.rgb.size(); i += 3) {
    values.push_back(photo.image.rgb[i]);
  }
  return values;
}

TEST(PhotoPng, CodesOfEightBitsStandAsTheyAre) {
  const Photo photo = Read(Rgb8());
  EXPECT_EQ(PhotoFormat::kPng, photo.format);
  EXPECT_EQ(8, photo.bits);
  EXPECT_EQ(8, photo.significant_bits);
  EXPECT_FALSE(photo.grey);
  ASSERT_EQ(18u, photo.image.rgb.size());
  for (size_t i = 0; i < 18; ++i) EXPECT_EQ(i, photo.image.rgb[i]);
  EXPECT_EQ(CurveKind::kUnknown, photo.curve.kind);
  EXPECT_TRUE(photo.notes.empty());
}

TEST(PhotoPng, SixteenBitsWithoutACurveAreUnknown) {
  PngSpec spec = Rgb8();
  spec.bits = 16;
  spec.rows = Ramp(36);
  spec.before = {{"sBIT", "\x0c\x0c\x0b"}};
  const Photo photo = Read(spec);
  EXPECT_EQ(16, photo.bits);
  EXPECT_EQ(12, photo.significant_bits);
  EXPECT_EQ(1.0f, photo.image.rgb[0]);  // bytes 0 1
  EXPECT_EQ(2.0f * 256 + 3, photo.image.rgb[1]);
  EXPECT_EQ(CurveKind::kUnknown, photo.curve.kind);
  EXPECT_EQ("", photo.curve.source);
}

TEST(PhotoPng, GreyOfEveryDepth) {
  PngSpec spec;
  spec.type = PNG_COLOR_TYPE_GRAY;
  spec.width = 3;
  spec.height = 1;
  const std::vector<std::tuple<int, std::string, std::vector<float>>> cases = {
      {1, std::string("\xa0", 1), {1, 0, 1}},
      {2, std::string("\x1c", 1), {0, 1, 3}},
      {4, std::string("\x0f\x70", 2), {0, 15, 7}},
      {8, std::string("\x00\x80\xff", 3), {0, 128, 255}},
      {16, std::string("\x00\x01\x80\x00\xff\xff", 6), {1, 32768, 65535}}};
  for (const auto& [bits, rows, expected] : cases) {
    spec.bits = bits;
    spec.rows = rows;
    const Photo photo = Read(spec);
    EXPECT_EQ(bits, photo.bits);
    EXPECT_TRUE(photo.grey);
    EXPECT_EQ(expected, RedOf(photo)) << bits;
    EXPECT_EQ(photo.image.rgb[3], photo.image.rgb[5]);
  }
}

TEST(PhotoPng, AlphaBecomesAMask) {
  PngSpec spec;
  spec.type = PNG_COLOR_TYPE_RGB_ALPHA;
  spec.width = 4;
  spec.height = 1;
  spec.rows = std::string("\1\2\3\xff\4\5\6\0\7\1\2\x80\1\1\1\xfe", 16);
  const Photo photo = Read(spec);
  EXPECT_EQ((std::vector<uint8_t>{1, 0, 0, 1}), photo.opaque.inside);
  EXPECT_EQ(4.0f, photo.image.rgb[3]);  // the colour stays
  ASSERT_EQ(1u, photo.notes.size());
  EXPECT_EQ(0u, photo.notes[0].find("1 pixels are partly transparent"));

  spec.bits = 16;
  spec.type = PNG_COLOR_TYPE_GRAY_ALPHA;
  spec.rows = std::string("\0\1\xff\xff\0\2\0\0\0\3\xff\xff\0\4\xff\xff", 16);
  const Photo grey = Read(spec);
  EXPECT_EQ((std::vector<uint8_t>{1, 0, 1, 1}), grey.opaque.inside);
  EXPECT_EQ((std::vector<float>{1, 2, 3, 4}), RedOf(grey));
}

TEST(PhotoPng, AlphaThatSaysNothingIsNoMask) {
  PngSpec spec;
  spec.type = PNG_COLOR_TYPE_GRAY_ALPHA;
  spec.width = 2;
  spec.height = 1;
  spec.rows = "\1\xff\2\xff";
  EXPECT_TRUE(Read(spec).opaque.empty());
  spec.rows = std::string("\1\0\2\0", 4);
  const Photo none = Read(spec);
  EXPECT_TRUE(none.opaque.empty());
  EXPECT_EQ(1u, none.notes.size());
}

TEST(PhotoPng, TransparentColours) {
  PngSpec spec = Rgb8();
  spec.before = {{"tRNS", std::string("\0\3\0\4\0\5", 6)}};
  EXPECT_EQ((std::vector<uint8_t>{1, 0, 1, 1, 1, 1}), Read(spec).opaque.inside);
  spec.type = PNG_COLOR_TYPE_GRAY;
  spec.bits = 2;
  spec.rows = std::string("\x1c\x1c", 2);  // 0 1 3, twice
  spec.before = {{"tRNS", std::string("\0\3", 2)}};
  const Photo grey = Read(spec);
  EXPECT_EQ((std::vector<uint8_t>{1, 1, 0, 1, 1, 0}), grey.opaque.inside);
  EXPECT_EQ((std::vector<float>{0, 1, 3, 0, 1, 3}), RedOf(grey));
}

TEST(PhotoPng, Palettes) {
  PngSpec spec;
  spec.type = PNG_COLOR_TYPE_PALETTE;
  spec.bits = 2;
  spec.width = 3;
  spec.height = 1;
  spec.rows = std::string("\x24", 1);  // 0 2 1
  spec.before = {{"PLTE", std::string("\0\0\0\x10\x20\x30\xff\xfe\xfd", 9)},
                 {"tRNS", std::string("\xff\xff\0", 3)}};
  const Photo photo = Read(spec);
  EXPECT_EQ(8, photo.bits);
  EXPECT_FALSE(photo.grey);
  EXPECT_EQ((std::vector<float>{0, 0, 0, 255, 254, 253, 16, 32, 48}),
            photo.image.rgb);
  EXPECT_EQ((std::vector<uint8_t>{1, 0, 1}), photo.opaque.inside);
  spec.rows = std::string("\x30", 1);  // index 3 has no colour
  EXPECT_FALSE(DecodePhoto("a.png", PngBytes(spec)).ok());
}

TEST(PhotoPng, InterlacedFilesOfLibpng) {
  std::string bytes;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, size_t size) {
        static_cast<std::string*>(png_get_io_ptr(p))
            ->append(reinterpret_cast<const char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, 9, 7, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_ADAM7,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::string rows = Ramp(9 * 7 * 3);
  std::vector<png_bytep> pointers;
  for (size_t y = 0; y < 7; ++y) {
    pointers.push_back(reinterpret_cast<png_bytep>(&rows[27 * y]));
  }
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  const StatusOr<Photo> photo = DecodePhoto("a.png", bytes);
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(static_cast<uint8_t>(rows[i]), photo->image.rgb[i]);
  }
}

CurveStatement CurveOf(const std::vector<PngChunk>& chunks) {
  PngSpec spec = Rgb8();
  spec.before = chunks;
  return Read(spec).curve;
}

PngChunk Gamma(uint32_t gamma) { return {"gAMA", BigEndianBytes(gamma, 4)}; }

PngChunk Icc(const std::string& profile) {
  return {"iCCP", std::string("p\0\0", 3) + ZlibBytes(profile)};
}

TEST(PhotoPng, WhatTheFileSaysOfItsCurve) {
  EXPECT_EQ(CurveKind::kSrgb, CurveOf({{"sRGB", std::string(1, '\0')}}).kind);
  const CurveStatement gamma = CurveOf({Gamma(45455)});
  EXPECT_EQ(CurveKind::kPower, gamma.kind);
  EXPECT_NEAR(2.2, gamma.exponent, 1e-3);  // of five digits
  EXPECT_EQ("gAMA 0.45455", gamma.source);
  EXPECT_EQ(CurveKind::kLinear, CurveOf({Gamma(100000)}).kind);
  // The sRGB chunk goes before the gAMA beside it.
  EXPECT_EQ("the sRGB chunk",
            CurveOf({Gamma(45455), {"sRGB", std::string(1, '\0')}}).source);
  const CurveStatement icc = CurveOf({Icc(RgbIcc("My lens", IccPower(1.8)))});
  EXPECT_EQ(CurveKind::kPower, icc.kind);
  EXPECT_NEAR(1.8, icc.exponent, 1.0 / 256);
  EXPECT_EQ("ICC profile 'My lens'", icc.source);
}

TEST(PhotoPng, CicpGoesFirst) {
  const auto cicp = [](const char* transfer) {
    return CurveOf({Gamma(45455),
                    {"cICP", std::string("\1", 1) + transfer[0] +
                                 std::string("\0\1", 2)}});
  };
  EXPECT_EQ(CurveKind::kSrgb, cicp("\x0d").kind);
  EXPECT_EQ(CurveKind::kLinear, cicp("\x08").kind);
  EXPECT_EQ(CurveKind::kPower, cicp("\x04").kind);
  EXPECT_EQ(CurveKind::kOther, cicp("\x10").kind);
  EXPECT_EQ("cICP transfer 16 (PQ)", cicp("\x10").source);
  // 2 is "unspecified": the next tag is asked.
  EXPECT_EQ("gAMA 0.45455", cicp("\x02").source);
}

TEST(PhotoPng, OtherPrimariesAreSaid) {
  PngSpec spec = Rgb8();
  EXPECT_FALSE(Read(spec).other_primaries);
  spec.before = {Icc(RgbIcc("Display P3", SrgbCurve(), true))};
  const Photo p3 = Read(spec);
  EXPECT_TRUE(p3.other_primaries);
  EXPECT_EQ(CurveKind::kSrgb, p3.curve.kind);
  EXPECT_EQ("Display P3", p3.tags.icc->description);
  spec.before = {{"cICP", std::string("\x09\x0d\0\1", 4)}};  // BT.2020
  EXPECT_TRUE(Read(spec).other_primaries);
  std::string chrm;
  for (const uint32_t v :
       {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000}) {
    chrm += BigEndianBytes(v, 4);
  }
  spec.before = {{"cHRM", chrm}};
  EXPECT_FALSE(Read(spec).other_primaries);
  chrm.replace(8, 4, BigEndianBytes(66000, 4));
  spec.before = {{"cHRM", chrm}};
  EXPECT_TRUE(Read(spec).other_primaries);
}

TEST(PhotoPng, ExifAndAspect) {
  PngSpec spec = Rgb8();
  spec.before = {{"pHYs", BigEndianBytes(2, 4) + BigEndianBytes(1, 4) + '\0'}};
  EXPECT_EQ(0.5, Read(spec).pixel_aspect);
  for (const bool after : {false, true}) {
    PngSpec turned = Rgb8();
    (after ? turned.after : turned.before)
        .push_back({"eXIf", ExifOfOrientation(6)});
    const Photo photo = Read(turned);
    EXPECT_EQ(6, photo.orientation);
    EXPECT_EQ(2, photo.image.width);
    EXPECT_EQ(3, photo.image.height);
    EXPECT_EQ(9.0f, photo.image.rgb[0]);  // the lower left pixel
  }
}

TEST(PhotoPng, DamagedFilesAreRefused) {
  PngSpec spec = Rgb8(20, 20);
  spec.before = {Icc(RgbIcc("x", SrgbCurve())), {"eXIf", ExifOfOrientation(3)}};
  const std::string whole = PngBytes(spec);
  ForEachTruncation(whole, 100, [](const std::string& bytes) {
    const Status status = DecodePhoto("a.png", bytes).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_EQ(0u, status.message().find("a.png"));
  });
  ForEachCorruption(whole, 400, 600, 1, [](const std::string& bytes) {
    const StatusOr<Photo> photo = DecodePhoto("a.png", bytes);
    if (photo.ok()) {
      EXPECT_EQ(1200u, photo->image.rgb.size());
    }
  });
}

// An eXIf chunk that claims a gigabyte. tests/fuzz/regressions/photo_png has
// one of 384 bytes, for which libpng takes that memory.
TEST(PhotoPng, ChunksThatClaimMuchAreRefused) {
  PngSpec spec = Rgb8();
  std::string bytes = PngBytes(spec);
  bytes.resize(bytes.size() - 12);  // IEND
  bytes += BigEndianBytes(0x4C326558, 4) + "eXIfII";
  const Status status = DecodePhoto("a.png", bytes).status();
  EXPECT_NE(std::string::npos, status.message().find("unexpected end of file"))
      << status.message();
}

TEST(PhotoPng, LargeClaimsAreRefused) {
  PngSpec spec = Rgb8();
  std::string bytes = PngBytes(spec);
  bytes.replace(16, 8, BigEndianBytes(30000, 4) + BigEndianBytes(30000, 4));
  bytes.replace(29, 4, BigEndianBytes(PngCrc(&bytes[12], 17), 4));
  const Status status = DecodePhoto("a.png", bytes).status();
  EXPECT_NE(std::string::npos, status.message().find("a.png: size"));
  bytes.replace(16, 8, BigEndianBytes(8000, 4) + BigEndianBytes(8000, 4));
  bytes.replace(29, 4, BigEndianBytes(PngCrc(&bytes[12], 17), 4));
  EXPECT_NE(std::string::npos, DecodePhoto("a.png", bytes)
                                   .status()
                                   .message()
                                   .find("too few bytes for its size"));
  PhotoOptions small;
  small.limits.pixels = 5;
  EXPECT_FALSE(DecodePhoto("a.png", PngBytes(spec), small).ok());
}

}  // namespace
}  // namespace ibrdf
