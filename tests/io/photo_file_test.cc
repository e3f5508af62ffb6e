// What holds of photographs of every format; PFM, .npy, HDR; ICC profiles.
#include "ibrdf/io/photo_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "ibrdf/io/exif.h"
#include "ibrdf/io/icc_profile.h"
#include "ibrdf/io/radiance_hdr.h"
#include "tests/support/corruption.h"
#include "tests/support/photo_files.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

void ExpectPhotoRefused(const std::string& bytes, const std::string& words,
                        const PhotoOptions& options = {}) {
  const Status status = DecodePhoto("a.x", bytes, options).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << words;
  EXPECT_EQ(0u, status.message().find("a.x")) << status.message();
  EXPECT_NE(std::string::npos, status.message().find(words))
      << status.message();
  EXPECT_EQ(std::string::npos, status.message().find('\n'));
}

std::string SmallPng() {
  PngSpec spec;
  spec.width = 2;
  spec.height = 1;
  spec.rows = "abcdef";
  return PngBytes(spec);
}

TEST(PhotoFile, TheContentChoosesTheFormat) {
  const TempDir dir;
  WriteBytes(dir.File("a.jpg"), SmallPng());
  const StatusOr<Photo> photo = ReadPhoto(dir.File("a.jpg"));
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(PhotoFormat::kPng, photo->format);
  EXPECT_STREQ("PNG", NameOf(photo->format));
}

TEST(PhotoFile, OtherFormatsAreNamed) {
  ExpectPhotoRefused("", "an empty file");
  ExpectPhotoRefused("this is not an image", "none of these");
  ExpectPhotoRefused(std::string("\0\0\0\x18", 4) + "ftypheic....", "HEIC");
  ExpectPhotoRefused("RIFF....WEBPVP8 ", "WebP");
  ExpectPhotoRefused("GIF89a....", "GIF");
  ExpectPhotoRefused("8BPS....", "Photoshop");
  ExpectPhotoRefused(std::string("\0\0\0\x0c", 4) + "JXL ", "JPEG XL");
  EXPECT_EQ(StatusCode::kInvalidInput,
            ReadPhoto("/nonexistent/a.png").status().code());
}

TEST(PhotoFile, LayersAreOfOpenExrAlone) {
  PhotoOptions options;
  options.layer = "beauty";
  ExpectPhotoRefused(SmallPng(), "a.x: layer: expected OpenEXR, PNG files",
                     options);
}

TEST(PhotoFile, NormalsAreThreeChannelsAndUpright) {
  PhotoOptions options;
  options.content = PhotoContent::kNormals;
  EXPECT_TRUE(DecodePhoto("a.x", SmallPng(), options).ok());
  PngSpec grey;
  grey.width = grey.height = 1;
  grey.type = PNG_COLOR_TYPE_GRAY;
  grey.rows = "a";
  ExpectPhotoRefused(PngBytes(grey), "channels", options);
  PngSpec turned;
  turned.width = turned.height = 1;
  turned.rows = "abc";
  turned.after = {{"eXIf", ExifOfOrientation(6)}};
  ExpectPhotoRefused(PngBytes(turned), "orientation", options);
}

// Each orientation undoes that whose turn is the inverse.
TEST(PhotoFile, OrientationsFormAGroup) {
  Image image(3, 2);
  Mask mask(3, 2, 0);
  for (size_t i = 0; i < 6; ++i) {
    image.rgb[3 * i] = static_cast<float>(i);
    mask.inside[i] = i % 2 == 0;
  }
  constexpr int kInverse[] = {1, 2, 3, 4, 5, 8, 7, 6};
  for (int o = 1; o <= 8; ++o) {
    const Image turned = Upright(image, o);
    EXPECT_EQ(o >= 5 ? 2 : 3, turned.width);
    EXPECT_EQ(image.rgb, Upright(turned, kInverse[o - 1]).rgb) << o;
    EXPECT_EQ(mask.inside, Upright(Upright(mask, o), kInverse[o - 1]).inside);
    if (o > 1) {
      EXPECT_NE(image.rgb, turned.rgb) << o;
    }
  }
}

TEST(PhotoFile, RadianceHdr) {
  const TempDir dir;
  Image image(9, 2);
  for (float& v : image.rgb) v = 0.5f;
  ASSERT_TRUE(WriteRadianceHdr(image, dir.File("a.hdr")).ok());
  const StatusOr<Photo> photo = ReadPhoto(dir.File("a.hdr"));
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(image.rgb, photo->image.rgb);
  EXPECT_EQ(CurveKind::kLinear, photo->curve.kind);
  EXPECT_EQ(0, photo->bits);
}

std::string FloatBytes(const std::vector<float>& values, bool big) {
  std::string bytes;
  for (const float v : values) {
    uint32_t bits = 0;
    std::memcpy(&bits, &v, sizeof(bits));
    bytes += big ? BigEndianBytes(bits, 4) : LittleEndianBytes(bits, 4);
  }
  return bytes;
}

TEST(PhotoFile, Pfm) {
  const std::vector<float> values = {1, 2, 3, 4, 5, 6, -7, 8, 1e30f, 0, 0, 1};
  for (const bool big : {false, true}) {
    const std::string bytes = std::string("PF\n2 2\n") +
                              (big ? "1.0\n" : "-1.0\n") +
                              FloatBytes(values, big);
    const StatusOr<Photo> photo = DecodePhoto("a.pfm", bytes);
    ASSERT_TRUE(photo.ok()) << photo.status().message();
    // The file's first row is the bottom.
    EXPECT_EQ((std::vector<float>{-7, 8, 1e30f, 0, 0, 1, 1, 2, 3, 4, 5, 6}),
              photo->image.rgb);
    EXPECT_EQ(CurveKind::kLinear, photo->curve.kind);
    for (size_t n = 2; n < bytes.size(); ++n) {
      EXPECT_FALSE(DecodePhoto("a.pfm", bytes.substr(0, n)).ok()) << n;
    }
  }
  const StatusOr<Photo> grey =
      DecodePhoto("a.pfm", "Pf 1 2 -2\n" + FloatBytes({3, 4}, false));
  ASSERT_TRUE(grey.ok()) << grey.status().message();
  EXPECT_TRUE(grey->grey);
  EXPECT_EQ((std::vector<float>{4, 4, 4, 3, 3, 3}), grey->image.rgb);
  EXPECT_EQ(1u, grey->notes.size());  // of the scale
  ExpectPhotoRefused("PF 0 2 -1\n", "size");
  ExpectPhotoRefused("PF 2 99999999999 -1\n", "size");
  ExpectPhotoRefused("PF 31000 31000 -1\n", "size");
  ExpectPhotoRefused("PF 1 1 0\n" + std::string(12, '\0'), "scale");
  ExpectPhotoRefused("PF 1 1 nan\n" + std::string(12, '\0'), "scale");
}

std::string Npy(const std::string& type, const std::string& shape,
                const std::string& data, const std::string& order = "False",
                int version = 1) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': " + order +
                       ", 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  bytes += LittleEndianBytes(static_cast<uint32_t>(header.size()),
                             version == 1 ? 2 : 4);
  return bytes + header + data;
}

TEST(PhotoFile, NpyOfEveryType) {
  const auto doubles = [](const std::vector<double>& v) {
    return std::string(reinterpret_cast<const char*>(v.data()), 8 * v.size());
  };
  const struct {
    std::string bytes;
    int bits;
  } kCases[] = {
      {Npy("|u1", "(1, 2, 3)", "\1\2\3\4\5\6"), 8},
      {Npy("<u2", "(1, 2, 3)", std::string("\1\0\2\0\3\0\4\0\5\0\6\0", 12)),
       16},
      {Npy("<f4", "(1, 2, 3)", FloatBytes({1, 2, 3, 4, 5, 6}, false), "False",
           2),
       0},
      {Npy("<f8", "(1,2,3)", doubles({1, 2, 3, 4, 5, 6}), "False", 3), 0}};
  for (const auto& c : kCases) {
    const StatusOr<Photo> photo = DecodePhoto("a.npy", c.bytes);
    ASSERT_TRUE(photo.ok()) << photo.status().message();
    EXPECT_EQ(2, photo->image.width);
    EXPECT_EQ(1, photo->image.height);
    EXPECT_EQ((std::vector<float>{1, 2, 3, 4, 5, 6}), photo->image.rgb);
    EXPECT_EQ(c.bits, photo->bits);
    EXPECT_EQ(c.bits == 0 ? CurveKind::kLinear : CurveKind::kUnknown,
              photo->curve.kind);
    for (size_t n = 6; n < c.bytes.size(); ++n) {
      EXPECT_FALSE(DecodePhoto("a.npy", c.bytes.substr(0, n)).ok()) << n;
    }
  }
  const StatusOr<Photo> large =
      DecodePhoto("a.npy", Npy("<f8", "(1, 2)", doubles({1e300, -1e-300})));
  ASSERT_TRUE(large.ok());
  EXPECT_TRUE(large->grey);
  EXPECT_TRUE(std::isinf(large->image.rgb[0]));
  EXPECT_EQ(0.0f, large->image.rgb[3]);
}

TEST(PhotoFile, NpyRefusedByField) {
  const std::string six = "\1\2\3\4\5\6";
  ExpectPhotoRefused(Npy(">f4", "(1, 1)", "abcd"), "descr");
  ExpectPhotoRefused(Npy("<i4", "(1, 1)", "abcd"), "descr");
  ExpectPhotoRefused(Npy("|O", "(1, 1)", "abcd"), "descr");
  ExpectPhotoRefused(Npy("|u1", "(1, 2, 3)", six, "True"), "fortran_order");
  ExpectPhotoRefused(Npy("|u1", "(6,)", six), "shape");
  ExpectPhotoRefused(Npy("|u1", "(3, 1, 2)", six), "found [3, 1, 2]");
  ExpectPhotoRefused(Npy("|u1", "(1, 1, 2, 3)", six), "shape");
  ExpectPhotoRefused(Npy("|u1", "(0, 3)", ""), "size");
  ExpectPhotoRefused(Npy("|u1", "(31000, 31000)", six), "size");
  ExpectPhotoRefused(Npy("|u1", "(1, 2, 3)", six + "7"), "found 7");
  ExpectPhotoRefused(Npy("|u1", "(-1, 6)", six), "header");
  ExpectPhotoRefused(Npy("|u1", "(1, 6", six), "header");
  ExpectPhotoRefused(Npy("|u1", "(1, 6), 'more': (1,)", six), "header");
  ExpectPhotoRefused(Npy("|u1", "(1, 6)", six, "False", 4), "version");
  ForEachCorruption(
      Npy("|u1", "(1, 2, 3)", six), 90, 2000, 3, [](const std::string& bytes) {
        const StatusOr<Photo> photo = DecodePhoto("a.npy", bytes);
        if (photo.ok()) {
          EXPECT_EQ(3 * photo->image.num_pixels(), photo->image.rgb.size());
        }
      });
}

TEST(IccProfile, CurvesByName) {
  const auto curve = [](const std::string& data) {
    return ParseIccProfile(RgbIcc("x", data))->curve;
  };
  EXPECT_EQ(CurveKind::kSrgb, curve(SrgbCurve()));
  EXPECT_EQ(CurveKind::kPower, curve(IccPower(2.2)));
  EXPECT_EQ(CurveKind::kLinear, curve(IccPower(1.0)));
  EXPECT_EQ(CurveKind::kLinear, curve("curv" + std::string(8, '\0')));
  EXPECT_EQ(CurveKind::kPower, curve(IccParametric(0, {1.8})));
  // 2.4 without the straight part, as a table of 1024 nodes of sRGB, and of a
  // power, which has no name.
  EXPECT_EQ(CurveKind::kOther, curve(IccParametric(3, {2.2, 1, 0, 1, 0.1})));
  std::string srgb = "curv" + std::string(4, '\0') + BigEndianBytes(1024, 4);
  std::string power = srgb;
  for (int i = 0; i < 1024; ++i) {
    const double y = i / 1023.0;
    const double linear =
        y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
    srgb += BigEndianBytes(static_cast<uint32_t>(65535 * linear + 0.5), 2);
    power += BigEndianBytes(
        static_cast<uint32_t>(65535 * std::pow(y, 2.2) + 0.5), 2);
  }
  EXPECT_EQ(CurveKind::kSrgb, curve(srgb));
  EXPECT_EQ(CurveKind::kOther, curve(power));
  EXPECT_EQ(CurveKind::kOther, curve(srgb.substr(0, 100)));
  EXPECT_EQ(CurveKind::kOther, curve(""));
}

TEST(IccProfile, TextAndColourSpace) {
  // Version 4: UTF-16, "Prüf".
  const std::string unicode =
      "mluc" + std::string(4, '\0') + BigEndianBytes(1, 4) +
      BigEndianBytes(12, 4) + "deDE" + BigEndianBytes(8, 4) +
      BigEndianBytes(28, 4) + std::string("\0P\0r\0\xfc\0f", 8);
  const auto profile = ParseIccProfile(
      IccBytes("GRAY", {{"desc", unicode}, {"kTRC", IccPower(2.2)}}));
  ASSERT_TRUE(profile.has_value());
  EXPECT_EQ(
      "Pr\xc3\xbc"
      "f",
      profile->description);
  EXPECT_EQ("GRAY", profile->colour_space);
  EXPECT_EQ(CurveKind::kPower, profile->curve);
  EXPECT_FALSE(ParseIccProfile("no profile").has_value());
  EXPECT_EQ("a?b", ParseIccProfile(RgbIcc("a\nb", ""))->description);
  const std::string whole = RgbIcc("sRGB", SrgbCurve());
  ForEachTruncation(whole, 100,
                    [](const std::string& bytes) { ParseIccProfile(bytes); });
  ForEachCorruption(whole, whole.size(), 2000, 5,
                    [](const std::string& bytes) { ParseIccProfile(bytes); });
}

TEST(Exif, AnyBytes) {
  const std::string whole = ExifBlock(
      {{0x0112, 3, 1, 6}, {0x8769, 4, 1, 8}, {0x829A, 5, 1, 10}}, true);
  EXPECT_EQ(6, ParseExif(whole).orientation);
  ForEachTruncation(whole, 60,
                    [](const std::string& bytes) { ParseExif(bytes); });
  ForEachCorruption(whole, whole.size(), 2000, 9, [](const std::string& bytes) {
    const int orientation = ParseExif(bytes).orientation;
    EXPECT_TRUE(orientation >= 1 && orientation <= 8);
  });
}

TEST(StateCurve, ByPrecedence) {
  ColourTags tags;
  EXPECT_EQ(CurveKind::kUnknown, StateCurve(tags, false).kind);
  EXPECT_EQ(CurveKind::kLinear, StateCurve(tags, true).kind);
  tags.exif_colour_space = 1;
  EXPECT_EQ("EXIF ColorSpace 1", StateCurve(tags, false).source);
  tags.png_gamma = 1.0;
  EXPECT_EQ(CurveKind::kLinear, StateCurve(tags, false).kind);
  tags.png_srgb = true;
  EXPECT_EQ("the sRGB chunk", StateCurve(tags, false).source);
  tags.icc = IccProfile{"lut", "RGB ", CurveKind::kOther, 1.0, false};
  EXPECT_EQ("ICC profile 'lut'", StateCurve(tags, false).source);
  EXPECT_EQ(CurveKind::kOther, StateCurve(tags, true).kind);
  tags.cicp = {1, 13, 0, 0};
  EXPECT_EQ("cICP transfer 13 of narrow range", StateCurve(tags, false).source);
}

}  // namespace
}  // namespace ibrdf
