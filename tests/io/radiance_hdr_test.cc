#include "ibrdf/io/radiance_hdr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/io/random_image.h"
#include "tests/support/corruption.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Half a step of the 8-bit mantissa against the pixel's largest channel, which
// has a mantissa of 128 or more.
constexpr float kRgbeError = 0.5f / 128;

const char kHead[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";

void ExpectClose(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    const float largest = std::max({a.rgb[i], a.rgb[i + 1], a.rgb[i + 2]});
    for (size_t c = i; c < i + 3; ++c) {
      EXPECT_NEAR(a.rgb[c], b.rgb[c], kRgbeError * largest);
    }
  }
}

TEST(RadianceHdr, RoundTripWithinThePrecisionOfTheFormat) {
  const TempDir dir;
  const std::string path = dir.File("a.hdr");
  // Flat scanlines below width 8, runs and literals above.
  for (const int width : {1, 7, 8, 200}) {
    Image image = RandomImage(width, 5, 1);
    if (width == 200) {
      for (int x = 20; x < 180; ++x) {
        for (int c = 0; c < 3; ++c) image.At(x, 2)[c] = 0.25f;
        if (x % 7 < 5) image.At(x, 3)[1] = 2.0f;
      }
    }
    ASSERT_TRUE(WriteRadianceHdr(image, path).ok());
    const StatusOr<Image> read = ReadRadianceHdr(path);
    ASSERT_TRUE(read.ok()) << read.status().message();
    ExpectClose(image, *read);
    // What was read is exactly representable: written again it is the same.
    ASSERT_TRUE(WriteRadianceHdr(*read, path).ok());
    EXPECT_EQ(read->rgb, ReadRadianceHdr(path)->rgb);
  }
}

TEST(RadianceHdr, RunsAreShort) {
  const TempDir dir;
  const std::string path = dir.File("a.hdr");
  ASSERT_TRUE(WriteRadianceHdr(Image(1000, 10), path).ok());
  // Per line 4 bytes and 4 planes of 8 runs of 2 bytes.
  EXPECT_LT(ReadBytes(path).size(), 10 * (4 + 4 * 8 * 2) + 100u);
}

TEST(RadianceHdr, ValuesBeyondTheFormat) {
  const TempDir dir;
  const std::string path = dir.File("a.hdr");
  Image image(8, 1);
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float values[8][3] = {{nan, -1.0f, 2.0f},   {nan, nan, nan},
                              {inf, 1.0f, 0.0f},    {3e38f, 0.0f, 0.0f},
                              {1e-44f, 0.0f, 0.0f}, {-inf, 0.0f, 1.0f},
                              {0.999f, 0.0f, 0.0f}, {255.9f, 255.0f, 1.0f}};
  for (int x = 0; x < 8; ++x) std::copy_n(values[x], 3, image.At(x, 0));
  ASSERT_TRUE(WriteRadianceHdr(image, path).ok());
  const Image read = ReadRadianceHdr(path).value();
  const float largest = std::ldexp(255.0f, 255 - 136);
  const float expected[8][3] = {{0, 0, 2},       {0, 0, 0},    {largest, 0, 0},
                                {largest, 0, 0}, {0, 0, 0},    {0, 0, 1},
                                {1, 0, 0},       {256, 256, 2}};
  for (int x = 0; x < 8; ++x) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(expected[x][c], read.At(x, 0)[c]) << x << " " << c;
    }
  }
}

TEST(RadianceHdr, KnownBytes) {
  const TempDir dir;
  const std::string path = dir.File("a.hdr");
  // Flat; 128 2^(129 - 136) = 1.
  WriteBytes(path, std::string(kHead) + "\n-Y 1 +X 2\n" +
                       std::string("\x80\x40\x01\x81\x80\x80\x80\x82", 8));
  Image image = ReadRadianceHdr(path).value();
  EXPECT_EQ((std::vector<float>{1.0f, 0.5f, 1.0f / 128, 2, 2, 2}), image.rgb);

  // Old runs: one pixel, then 3 and 1 * 256 repeats of it.
  WriteBytes(path, std::string(kHead) + "\n-Y 1 +X 260\n" +
                       std::string("\x80\x40\x20\x81\1\1\1\3\1\1\1\1", 12));
  image = ReadRadianceHdr(path).value();
  for (int x = 0; x < 260; ++x) {
    EXPECT_EQ(1.0f, image.At(x, 0)[0]);
    EXPECT_EQ(0.25f, image.At(x, 0)[2]);
  }

  // New runs: plane red as run of 8, green as 8 literals, blue 5 + 3.
  WriteBytes(path, std::string(kHead) + "\n-Y 1 +X 8\n" +
                       std::string("\2\2\0\x08\x88\x80", 6) +
                       std::string("\x08\0\x10\x20\x30\x40\x50\x60\x70", 9) +
                       std::string("\x85\x80\x03\1\2\3", 6) +
                       std::string("\x88\x81", 2));
  const StatusOr<Image> read = ReadRadianceHdr(path);
  ASSERT_TRUE(read.ok()) << read.status().message();
  for (int x = 0; x < 8; ++x) {
    EXPECT_EQ(1.0f, read->At(x, 0)[0]);
    EXPECT_EQ(static_cast<float>(x) / 8, read->At(x, 0)[1]);
    EXPECT_EQ(x < 5 ? 1.0f : static_cast<float>(x - 4) / 128,
              read->At(x, 0)[2]);
  }
}

TEST(RadianceHdr, ExposureAndColourCorrectionAreUndone) {
  const TempDir dir;
  const std::string path = dir.File("a.hdr");
  WriteBytes(path, std::string(kHead) +
                       "EXPOSURE=2\n# EXPOSURE=100\nEXPOSURE= 4.0\n"
                       "COLORCORR=1 2 0.5\n\n-Y 1 +X 1\n\x80\x80\x80\x81");
  const Image image = ReadRadianceHdr(path).value();
  EXPECT_EQ((std::vector<float>{1.0f / 8, 1.0f / 16, 1.0f / 4}), image.rgb);
  for (const char* bad :
       {"EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=nan", "EXPOSURE=x",
        "EXPOSURE=1e400", "COLORCORR=1 1", "COLORCORR=1 0 1"}) {
    WriteBytes(path, std::string(kHead) + bad + "\n\n-Y 1 +X 1\nabcd");
    const Status status = ReadRadianceHdr(path).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << bad;
    EXPECT_NE(std::string::npos, status.message().find(path)) << bad;
  }
}

TEST(RadianceHdr, OtherKindsAreRefusedByName) {
  const TempDir dir;
  const std::string path = dir.File("a.hdr");
  const auto message = [&](const std::string& bytes) {
    WriteBytes(path, bytes);
    const Status status = ReadRadianceHdr(path).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    return status.message();
  };
  EXPECT_NE(std::string::npos,
            message("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd")
                .find("FORMAT: expected 32-bit_rle_rgbe"));
  for (const char* resolution :
       {"+Y 1 +X 1", "-Y 1 -X 1", "+X 1 -Y 1", "-Y 1", "-Y 1 +X", "-Y 1 +X 1x",
        "-Y  +X 1", "", "-Y 99999999999 +X 1"}) {
    EXPECT_NE(std::string::npos,
              message(std::string(kHead) + "\n" + resolution + "\nabcd")
                  .find("resolution: expected \"-Y height +X width\""))
        << resolution;
  }
  for (const char* size : {"-Y 0 +X 1", "-Y 1 +X 0", "-Y 1 +X 32769",
                           "-Y 32768 +X 32768", "-Y 999999999 +X 999999999"}) {
    EXPECT_NE(std::string::npos,
              message(std::string(kHead) + "\n" + size + "\nabcd")
                  .find("size: expected"))
        << size;
  }
  // Sizes within the limits, but next to no pixels.
  message(std::string(kHead) + "\n-Y 2048 +X 32768\nabcd");
  message("P6 1 1 255\n");
  message("#?RADIANCE\n");
  // A run without a pixel to repeat; runs longer than the line.
  message(std::string(kHead) + "\n-Y 1 +X 4\n\1\1\1\3");
  message(std::string(kHead) + "\n-Y 1 +X 4\n\2\3\4\5\1\1\1\4");
}

TEST(RadianceHdr, DamagedFiles) {
  const TempDir dir;
  const std::string path = dir.File("a.hdr");
  const auto check = [&](const std::string& bytes) {
    const StatusOr<Image> read = DecodeRadianceHdr(path, bytes);
    if (read.ok()) {
      EXPECT_EQ(read->num_pixels() * 3, read->rgb.size());
    } else {
      EXPECT_EQ(StatusCode::kInvalidInput, read.status().code());
    }
  };
  const auto check_refused = [&](const std::string& bytes) {
    EXPECT_FALSE(DecodeRadianceHdr(path, bytes).ok());
  };
  for (const int width : {6, 40}) {
    ASSERT_TRUE(WriteRadianceHdr(RandomImage(width, 20, 2), path).ok());
    const std::string bytes = ReadBytes(path);
    ForEachTruncation(bytes, 200, check_refused);
    ForEachCorruption(bytes, 60, 2000, 3, check);
  }
}

TEST(RadianceHdr, WhatIsNotAFileAndWhatCannotBeWritten) {
  const TempDir dir;
  EXPECT_FALSE(ReadRadianceHdr(dir.File("missing.hdr")).ok());
  EXPECT_FALSE(ReadRadianceHdr(dir.path()).ok());
  WriteBytes(dir.File("empty.hdr"), "");
  EXPECT_FALSE(ReadRadianceHdr(dir.File("empty.hdr")).ok());
  EXPECT_EQ(StatusCode::kInvalidInput,
            WriteRadianceHdr(Image(2, 2), dir.File("none/a.hdr")).code());
  EXPECT_EQ(StatusCode::kInternal,
            WriteRadianceHdr(Image(), dir.File("a.hdr")).code());
  EXPECT_EQ(1, dir.CountFiles());
}

TEST(RadianceHdr, SharedMaps) {
  IBRDF_REQUIRE_SHARED_DATA(data_dir);
  int maps = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(data_dir + "/envmaps")) {
    if (entry.path().extension() != ".hdr") continue;
    ++maps;
    const StatusOr<Image> map = ReadRadianceHdr(entry.path().string());
    ASSERT_TRUE(map.ok()) << map.status().message();
    EXPECT_EQ(512, map->width);
    EXPECT_EQ(256, map->height);
    double sum = 0.0;
    for (const float v : map->rgb) {
      ASSERT_TRUE(std::isfinite(v) && v >= 0.0f);
      sum += v;
    }
    EXPECT_GT(sum, 0.0);
  }
  EXPECT_GT(maps, 0);
}

}  // namespace
}  // namespace ibrdf
