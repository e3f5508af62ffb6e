// TIFF photographs: numbers, layouts, compressions, tags, what is refused.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "ibrdf/io/photo_file.h"
#include "tests/support/corruption.h"
#include "tests/support/photo_files.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

template <typename T>
std::string BytesOf(const std::vector<T>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()),
                     values.size() * sizeof(T));
}

// Values 1, 2, 3, ... of type T.
template <typename T>
TiffSpec Ramp(int width, int height, int samples) {
  TiffSpec spec;
  spec.width = width;
  spec.height = height;
  spec.samples = samples;
  spec.bits = 8 * static_cast<int>(sizeof(T));
  spec.photometric = samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
  if (!std::numeric_limits<T>::is_integer) spec.format = SAMPLEFORMAT_IEEEFP;
  std::vector<T> values;
  for (int i = 1; i <= width * height * samples; ++i) {
    values.push_back(static_cast<T>(i));
  }
  spec.values = BytesOf(values);
  return spec;
}

StatusOr<Photo> Read(const std::vector<TiffSpec>& specs,
                     const PhotoOptions& options = {}) {
  const TempDir dir;
  WriteTiff(dir.File("a.tif"), specs);
  return DecodePhoto("a.tif", ReadBytes(dir.File("a.tif")), options);
}

// The colours are 1, 2, 3, ... of `samples` a pixel.
void ExpectRamp(const StatusOr<Photo>& photo, int bits, size_t samples = 3) {
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(bits, photo->bits);
  for (size_t i = 0; i < photo->image.rgb.size(); ++i) {
    const size_t channel = samples < 3 ? 0 : i % 3;
    EXPECT_EQ(static_cast<float>(i / 3 * samples + channel + 1),
              photo->image.rgb[i])
        << i;
  }
}

TEST(PhotoTiff, CodesAndFloats) {
  ExpectRamp(Read({Ramp<uint8_t>(7, 5, 3)}), 8);
  ExpectRamp(Read({Ramp<uint16_t>(7, 5, 3)}), 16);
  const StatusOr<Photo> floats = Read({Ramp<float>(7, 5, 3)});
  ExpectRamp(floats, 0);
  EXPECT_EQ(CurveKind::kLinear, floats->curve.kind);
  ExpectRamp(Read({Ramp<double>(7, 5, 3)}), 0);
  TiffSpec halves = Ramp<uint16_t>(2, 1, 3);
  halves.format = SAMPLEFORMAT_IEEEFP;
  halves.values = BytesOf<uint16_t>(
      {0x3C00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600});  // 1 to 6
  ExpectRamp(Read({halves}), 0);
  const StatusOr<Photo> codes = Read({Ramp<uint16_t>(2, 1, 3)});
  EXPECT_EQ(CurveKind::kUnknown, codes->curve.kind);
  EXPECT_EQ(16, codes->significant_bits);
}

TEST(PhotoTiff, LayoutsAndCompressions) {
  for (const uint16_t compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
        COMPRESSION_DEFLATE, COMPRESSION_PACKBITS, COMPRESSION_ZSTD}) {
    for (const bool planes : {false, true}) {
      for (const int tile : {0, 16}) {
        for (const char* mode : {"wl", "wb", "w8"}) {
          TiffSpec spec = Ramp<uint16_t>(21, 18, 3);
          spec.compression = compression;
          spec.planes = planes;
          spec.tile = tile;
          spec.rows_per_strip = 5;  // the last strip has fewer
          spec.mode = mode;
          SCOPED_TRACE(std::to_string(compression) + mode +
                       (planes ? " planes" : "") + (tile ? " tiles" : ""));
          ExpectRamp(Read({spec}), 16);
        }
      }
    }
  }
}

TEST(PhotoTiff, Predictors) {
  TiffSpec differences = Ramp<uint16_t>(21, 18, 3);
  differences.compression = COMPRESSION_LZW;
  differences.predictor = PREDICTOR_HORIZONTAL;
  ExpectRamp(Read({differences}), 16);
  TiffSpec floats = Ramp<float>(21, 18, 3);
  floats.compression = COMPRESSION_ADOBE_DEFLATE;
  floats.predictor = PREDICTOR_FLOATINGPOINT;
  ExpectRamp(Read({floats}), 0);
}

TEST(PhotoTiff, JpegInside) {
  TiffSpec spec = Ramp<uint8_t>(32, 16, 3);
  spec.compression = COMPRESSION_JPEG;
  spec.photometric = PHOTOMETRIC_YCBCR;
  spec.rows_per_strip = 16;
  std::fill(spec.values.begin(), spec.values.end(), '\x50');
  const StatusOr<Photo> photo = Read({spec});
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  for (const float value : photo->image.rgb) EXPECT_NEAR(0x50, value, 2.0f);
}

TEST(PhotoTiff, GreyAndWhiteIsZero) {
  const StatusOr<Photo> grey = Read({Ramp<uint8_t>(5, 4, 1)});
  ExpectRamp(grey, 8, 1);
  EXPECT_TRUE(grey->grey);
  TiffSpec inverted = Ramp<uint8_t>(5, 4, 1);
  inverted.photometric = PHOTOMETRIC_MINISWHITE;
  const StatusOr<Photo> photo = Read({inverted});
  ASSERT_TRUE(photo.ok());
  EXPECT_EQ(254.0f, photo->image.rgb[0]);
  TiffSpec bits;
  bits.width = 5;
  bits.height = 2;
  bits.samples = 1;
  bits.bits = 1;
  bits.photometric = PHOTOMETRIC_MINISBLACK;
  bits.values = "\xa8\x50";
  const StatusOr<Photo> mask = Read({bits});
  ASSERT_TRUE(mask.ok()) << mask.status().message();
  EXPECT_EQ(1, mask->bits);
  for (size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(i % 2 == 0 ? 1.0f : 0.0f, mask->image.rgb[3 * i]) << i;
  }
}

TEST(PhotoTiff, Palettes) {
  TiffSpec spec;
  spec.width = 3;
  spec.height = 1;
  spec.samples = 1;
  spec.bits = 4;
  spec.photometric = PHOTOMETRIC_PALETTE;
  spec.values = std::string("\x01\x20", 2);  // 0 1 2
  spec.palette.assign(48, 0);
  spec.palette[1] = 257 * 9;
  spec.palette[16 + 2] = 65535;
  const StatusOr<Photo> photo = Read({spec});
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(8, photo->bits);
  EXPECT_FALSE(photo->grey);
  EXPECT_EQ((std::vector<float>{0, 0, 0, 9, 0, 0, 0, 255, 0}),
            photo->image.rgb);
  spec.palette[1] = 1000;
  EXPECT_EQ(16, Read({spec})->bits);
}

TEST(PhotoTiff, AlphaOrientationAndProfile) {
  TiffSpec spec = Ramp<uint16_t>(3, 2, 4);
  spec.extra = {EXTRASAMPLE_UNASSALPHA};
  uint16_t values[24];
  std::memcpy(values, spec.values.data(), sizeof(values));
  for (size_t i = 3; i < 24; i += 4) values[i] = 65535;
  values[7] = 0;  // of the second pixel
  std::memcpy(spec.values.data(), values, sizeof(values));
  spec.orientation = 8;
  spec.icc = RgbIcc("ProPhoto", IccPower(1.8), true);
  const StatusOr<Photo> photo = Read({spec});
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(8, photo->orientation);
  ASSERT_EQ(2, photo->image.width);
  ASSERT_EQ(3, photo->image.height);
  // Orientation 8: the first column is the bottom row.
  EXPECT_EQ(1.0f, *photo->image.At(0, 2));
  EXPECT_EQ(5.0f, *photo->image.At(0, 1));
  EXPECT_EQ((std::vector<uint8_t>{1, 1, 0, 1, 1, 1}), photo->opaque.inside);
  EXPECT_EQ(CurveKind::kPower, photo->curve.kind);
  EXPECT_TRUE(photo->other_primaries);
  // A fourth channel of no kind is left out.
  spec.extra = {EXTRASAMPLE_UNSPECIFIED};
  EXPECT_TRUE(Read({spec})->opaque.empty());
}

TEST(PhotoTiff, ThumbnailsAreSkipped) {
  TiffSpec small = Ramp<uint8_t>(2, 2, 3);
  small.kind = FILETYPE_REDUCEDIMAGE;
  const StatusOr<Photo> photo =
      Read({small, Ramp<uint8_t>(5, 4, 3), Ramp<uint8_t>(6, 6, 3)});
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(5, photo->image.width);
  EXPECT_EQ(2, Read({small})->image.width);
}

void ExpectTiffRefused(const TiffSpec& spec, const std::string& words) {
  const Status status = Read({spec}).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(0u, status.message().find("a.tif"));
  EXPECT_NE(std::string::npos, status.message().find(words))
      << status.message();
}

TEST(PhotoTiff, RefusedByName) {
  TiffSpec cmyk = Ramp<uint8_t>(4, 2, 4);
  cmyk.photometric = PHOTOMETRIC_SEPARATED;
  ExpectTiffRefused(cmyk, "CMYK");
  TiffSpec lab = Ramp<uint8_t>(4, 2, 3);
  lab.photometric = PHOTOMETRIC_CIELAB;
  ExpectTiffRefused(lab, "CIE Lab");
  TiffSpec raw = Ramp<uint16_t>(4, 2, 1);
  raw.photometric = PHOTOMETRIC_CFA;
  ExpectTiffRefused(raw, "raw sensor data");
  TiffSpec twelve = Ramp<uint8_t>(4, 2, 3);
  twelve.bits = 12;
  twelve.values.resize(2 * 4 * 3 * 12 / 8);
  ExpectTiffRefused(twelve, "found 12");
  TiffSpec whole = Ramp<uint32_t>(4, 2, 3);
  ExpectTiffRefused(whole, "found 32");
  TiffSpec signed_numbers = Ramp<uint16_t>(4, 2, 3);
  signed_numbers.format = SAMPLEFORMAT_INT;
  ExpectTiffRefused(signed_numbers, "SampleFormat 2");
  TiffSpec fax = Ramp<uint8_t>(8, 2, 1);
  fax.bits = 1;
  fax.values = "ab";
  fax.compression = COMPRESSION_CCITTFAX4;
  ExpectTiffRefused(fax, "compression");
}

TEST(PhotoTiff, DamagedFilesAreRefused) {
  const TempDir dir;
  for (const uint16_t compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
        COMPRESSION_ZSTD, COMPRESSION_JPEG}) {
    TiffSpec spec = Ramp<uint8_t>(24, 24, 3);
    spec.compression = compression;
    if (compression == COMPRESSION_JPEG) spec.rows_per_strip = 8;
    WriteTiff(dir.File("a.tif"), {spec});
    const std::string whole = ReadBytes(dir.File("a.tif"));
    // The directory stands at the end.
    ForEachTruncation(whole, 50, [&](const std::string& bytes) {
      const StatusOr<Photo> photo = DecodePhoto("a.tif", bytes);
      EXPECT_FALSE(photo.ok() && bytes.size() + 20 < whole.size());
      if (!photo.ok()) {
        EXPECT_EQ(StatusCode::kInvalidInput, photo.status().code());
        EXPECT_EQ(0u, photo.status().message().find("a.tif"));
      }
    });
    ForEachCorruption(
        whole, whole.size(), 600, 5, [](const std::string& bytes) {
          const StatusOr<Photo> photo = DecodePhoto("a.tif", bytes);
          if (photo.ok()) {
            EXPECT_EQ(3 * photo->image.num_pixels(), photo->image.rgb.size());
          }
        });
  }
}

TEST(PhotoTiff, LargeClaimsAreRefused) {
  PhotoOptions small;
  small.limits.pixels = 20;
  EXPECT_NE(std::string::npos, Read({Ramp<uint8_t>(7, 5, 3)}, small)
                                   .status()
                                   .message()
                                   .find("a.tif: size"));
  // 8000 x 8000 pixels in a file of some hundred bytes.
  const TempDir dir;
  TiffSpec spec = Ramp<uint8_t>(3, 2, 3);
  WriteTiff(dir.File("a.tif"), {spec});
  std::string bytes = ReadBytes(dir.File("a.tif"));
  for (const uint32_t tag : {256u, 257u, 278u}) {
    const std::string entry = LittleEndianBytes(tag, 2);
    size_t at =
        bytes.find(entry + LittleEndianBytes(3, 2) + LittleEndianBytes(1, 4));
    ASSERT_NE(std::string::npos, at) << tag;
    bytes.replace(at + 8, 2, LittleEndianBytes(8000, 2));
  }
  EXPECT_NE(std::string::npos, DecodePhoto("a.tif", bytes)
                                   .status()
                                   .message()
                                   .find("too few bytes for its size"));
}

}  // namespace
}  // namespace ibrdf
