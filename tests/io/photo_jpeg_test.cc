// JPEG photographs: kinds, EXIF, ICC, what is refused and why.
#include <gtest/gtest.h>

#include "ibrdf/io/photo_file.h"
#include "tests/support/corruption.h"
#include "tests/support/photo_files.h"

namespace ibrdf {
namespace {

// A smooth picture, which quality 100 keeps within a few codes.
JpegSpec Smooth(int width, int height, int channels = 3) {
  JpegSpec spec;
  spec.width = width;
  spec.height = height;
  spec.channels = channels;
  spec.colours = channels == 1   ? JCS_GRAYSCALE
                 : channels == 3 ? JCS_RGB
                                 : JCS_CMYK;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        spec.values.push_back(
            static_cast<uint8_t>(40 + 5 * x + 3 * y + 20 * c));
      }
    }
  }
  return spec;
}

StatusOr<Photo> Read(const JpegSpec& spec) {
  return DecodePhoto("a.jpg", JpegBytes(spec));
}

// Codes that quality 100 loses: rounding of YCbCr and of the transform.
constexpr float kCodes = 3.0f;

TEST(PhotoJpeg, ColoursOfBaselineAndProgressive) {
  for (const bool progressive : {false, true}) {
    JpegSpec spec = Smooth(19, 13);
    spec.progressive = progressive;
    spec.subsample = !progressive;
    const StatusOr<Photo> photo = Read(spec);
    ASSERT_TRUE(photo.ok()) << photo.status().message();
    EXPECT_EQ(PhotoFormat::kJpeg, photo->format);
    EXPECT_EQ(8, photo->bits);
    EXPECT_FALSE(photo->grey);
    ASSERT_EQ(spec.values.size(), photo->image.rgb.size());
    for (size_t i = 0; i < spec.values.size(); ++i) {
      EXPECT_NEAR(spec.values[i], photo->image.rgb[i], kCodes);
    }
    EXPECT_EQ(CurveKind::kUnknown, photo->curve.kind);
  }
}

TEST(PhotoJpeg, Grey) {
  const JpegSpec spec = Smooth(9, 5, 1);
  const StatusOr<Photo> photo = Read(spec);
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_TRUE(photo->grey);
  for (size_t i = 0; i < photo->image.rgb.size(); ++i) {
    EXPECT_NEAR(spec.values[i / 3], photo->image.rgb[i], kCodes);
  }
}

// The stored picture has one bright corner, where EXIF says it is to be seen.
TEST(PhotoJpeg, EveryOrientation) {
  // Corner of the stored top left pixel: row from the bottom, column from the
  // right, in the upright picture; whether sides change places.
  const struct {
    bool bottom, right, sideways;
  } kCorners[] = {{false, false, false}, {false, true, false},
                  {true, true, false},   {true, false, false},
                  {false, false, true},  {false, true, true},
                  {true, true, true},    {true, false, true}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    for (const bool big_endian : {false, true}) {
      JpegSpec spec = Smooth(32, 16, 1);
      std::fill(spec.values.begin(), spec.values.end(), uint8_t{10});
      // A block of 8, then a darker one below: orientation 2 differs from 1
      // along x, 5 from 1 along the diagonal.
      for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
          spec.values[static_cast<size_t>(32 * y + x)] = 250;
          spec.values[static_cast<size_t>(32 * (y + 8) + x)] = 120;
        }
      }
      spec.markers = {ExifMarker(ExifBlock(
          {{0x0112, 3, 1, static_cast<uint32_t>(orientation)}}, big_endian))};
      const StatusOr<Photo> photo = Read(spec);
      ASSERT_TRUE(photo.ok()) << photo.status().message();
      EXPECT_EQ(orientation, photo->orientation);
      const auto& corner = kCorners[orientation - 1];
      const int width = corner.sideways ? 16 : 32;
      const int height = corner.sideways ? 32 : 16;
      ASSERT_EQ(width, photo->image.width);
      ASSERT_EQ(height, photo->image.height);
      const int x = corner.right ? width - 4 : 3;
      const int y = corner.bottom ? height - 4 : 3;
      EXPECT_NEAR(250, *photo->image.At(x, y), kCodes) << orientation;
      // Below it in the file: along the picture's other side when sideways.
      const int dx = corner.sideways ? (corner.right ? -8 : 8) : 0;
      const int dy = corner.sideways ? 0 : (corner.bottom ? -8 : 8);
      EXPECT_NEAR(120, *photo->image.At(x + dx, y + dy), kCodes) << orientation;
    }
  }
}

TEST(PhotoJpeg, ExifColourAndExposure) {
  // Table of EXIF at 26, two numbers after it.
  const auto exif = [](uint32_t colour_space) {
    const uint32_t table = 14 + 12;
    const uint32_t rational = table + 2 + 4 * 12 + 4;
    const auto n = LittleEndianBytes;
    const std::string entries =
        n(4, 2) + n(0xA001, 2) + n(3, 2) + n(1, 4) + n(colour_space, 4) +
        n(0x829A, 2) + n(5, 2) + n(1, 4) + n(rational, 4) + n(0x829D, 2) +
        n(5, 2) + n(1, 4) + n(rational + 8, 4) + n(0x8827, 2) + n(3, 2) +
        n(1, 4) + n(400, 4) + n(0, 4);
    return ExifBlock({{0x8769, 4, 1, table}}, false,
                     entries + n(1, 4) + n(125, 4) + n(28, 4) + n(10, 4));
  };
  JpegSpec spec = Smooth(8, 8);
  spec.markers = {ExifMarker(exif(1))};
  const StatusOr<Photo> photo = Read(spec);
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(CurveKind::kSrgb, photo->curve.kind);
  EXPECT_EQ("EXIF ColorSpace 1", photo->curve.source);
  EXPECT_DOUBLE_EQ(1.0 / 125, photo->exposure_seconds.value());
  EXPECT_DOUBLE_EQ(2.8, photo->f_number.value());
  EXPECT_EQ(400, photo->iso.value());
  spec.markers = {ExifMarker(exif(65535))};
  EXPECT_EQ(CurveKind::kUnknown, Read(spec)->curve.kind);
  EXPECT_EQ("EXIF ColorSpace 65535", Read(spec)->curve.source);
  spec.markers = {ExifMarker(exif(2))};
  EXPECT_EQ(CurveKind::kPower, Read(spec)->curve.kind);
  EXPECT_TRUE(Read(spec)->other_primaries);
}

TEST(PhotoJpeg, DamagedExifIsSaidAndThePictureRead) {
  JpegSpec spec = Smooth(8, 8);
  for (const std::string& block :
       {std::string("II"), ExifOfOrientation(9),
        ExifOfOrientation(6).substr(0, 15),
        ExifBlock({{0x8769, 4, 1, 0xFFFFFFFF}}),
        ExifBlock({{0x8769, 4, 1, 8}})}) {  // a table that is its own part
    spec.markers = {ExifMarker(block)};
    const StatusOr<Photo> photo = Read(spec);
    ASSERT_TRUE(photo.ok()) << photo.status().message();
    EXPECT_EQ(1, photo->orientation);
    ASSERT_EQ(1u, photo->notes.size());
    EXPECT_NE(std::string::npos, photo->notes[0].find("EXIF"));
  }
}

TEST(PhotoJpeg, IccProfile) {
  JpegSpec spec = Smooth(8, 8);
  // Longer than a marker may be: it comes in parts.
  spec.icc = RgbIcc("sRGB built-in", SrgbCurve());
  spec.icc.append(70000, '\0');
  spec.markers = {ExifMarker(ExifOfOrientation(1))};
  const StatusOr<Photo> photo = Read(spec);
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(CurveKind::kSrgb, photo->curve.kind);
  EXPECT_EQ("ICC profile 'sRGB built-in'", photo->curve.source);
  EXPECT_FALSE(photo->other_primaries);
}

void ExpectJpegRefused(const std::string& bytes, const std::string& words) {
  const Status status = DecodePhoto("a.jpg", bytes).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(0u, status.message().find("a.jpg"));
  EXPECT_NE(std::string::npos, status.message().find(words))
      << status.message();
}

TEST(PhotoJpeg, CmykAndTwelveBitsAreRefusedByName) {
  ExpectJpegRefused(JpegBytes(Smooth(8, 8, 4)), "CMYK");
  std::string bytes = JpegBytes(Smooth(8, 8));
  const size_t frame = bytes.find(std::string("\xff\xc0\0\x11\x08", 5));
  ASSERT_NE(std::string::npos, frame);
  bytes[frame + 4] = 12;
  ExpectJpegRefused(bytes, "expected 8 bits, found 12");
  bytes[frame + 4] = 8;
  bytes[frame + 1] = '\xc3';  // lossless
  ExpectJpegRefused(bytes, "JPEG");
}

TEST(PhotoJpeg, DamagedFilesAreRefused) {
  for (const bool progressive : {false, true}) {
    JpegSpec spec = Smooth(40, 40);
    spec.progressive = progressive;
    spec.restart_interval = progressive ? 0 : 3;
    spec.markers = {ExifMarker(ExifOfOrientation(6))};
    const std::string whole = JpegBytes(spec);
    ForEachTruncation(whole, 200, [](const std::string& bytes) {
      const Status status = DecodePhoto("a.jpg", bytes).status();
      EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << bytes.size();
      EXPECT_EQ(0u, status.message().find("a.jpg"));
    });
    ForEachCorruption(whole, 600, 600, 3, [](const std::string& bytes) {
      const StatusOr<Photo> photo = DecodePhoto("a.jpg", bytes);
      if (photo.ok()) {
        EXPECT_EQ(3 * photo->image.num_pixels(), photo->image.rgb.size());
      }
    });
  }
}

TEST(PhotoJpeg, BytesBetweenMarkersAreNoDamage) {
  std::string bytes = JpegBytes(Smooth(8, 8));
  bytes.insert(bytes.size() - 2, std::string(5, '\0'));
  const StatusOr<Photo> photo = DecodePhoto("a.jpg", bytes);
  EXPECT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_TRUE(DecodePhoto("a.jpg", JpegBytes(Smooth(8, 8)) + "junk").ok());
}

TEST(PhotoJpeg, LargeClaimsAreRefused) {
  std::string bytes = JpegBytes(Smooth(8, 8));
  const size_t frame = bytes.find(std::string("\xff\xc0\0\x11\x08", 5));
  ASSERT_NE(std::string::npos, frame);
  bytes.replace(frame + 5, 4, "\x75\x30\x75\x30");  // 30000 x 30000
  ExpectJpegRefused(bytes, "a.jpg: size");
}

TEST(PhotoJpeg, ManyScansAreRefused) {
  JpegSpec spec = Smooth(8, 8);
  spec.progressive = true;
  const std::string bytes = JpegBytes(spec);
  // The last scan again and again.
  const size_t scan = bytes.rfind("\xff\xda");
  std::string many = bytes.substr(0, bytes.size() - 2);
  for (int k = 0; k < 200; ++k) {
    many += bytes.substr(scan, bytes.size() - 2 - scan);
  }
  EXPECT_FALSE(DecodePhoto("a.jpg", many + "\xff\xd9").ok());
}

}  // namespace
}  // namespace ibrdf
