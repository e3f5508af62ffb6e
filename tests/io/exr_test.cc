#include "ibrdf/io/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/io/random_image.h"
#include "tests/support/corruption.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Round to nearest half: 11 significant bits.
constexpr float kHalfRelativeError = 1.0f / 2048;

void ExpectSameBits(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.rgb.size(), b.rgb.size());
  EXPECT_EQ(
      0, std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)));
}

struct NamedChannel {
  std::string name;
  int source;  // channel of the image
};

Imf::FrameBuffer FloatFrame(const Image& image, const Imath::Box2i& window,
                            const std::vector<NamedChannel>& channels) {
  Imf::FrameBuffer frame;
  for (const NamedChannel& c : channels) {
    frame.insert(
        c.name,
        Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + c.source, window,
                         3 * sizeof(float), 3 * sizeof(float) * image.width));
  }
  return frame;
}

void WriteChannels(const std::string& path, const Image& image,
                   const std::vector<NamedChannel>& channels) {
  Imf::Header header(image.width, image.height);
  for (const NamedChannel& c : channels) {
    header.channels().insert(c.name, Imf::Channel(Imf::FLOAT));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(FloatFrame(image, header.dataWindow(), channels));
  file.writePixels(image.height);
}

const std::vector<NamedChannel> kRgb = {{"R", 0}, {"G", 1}, {"B", 2}};

TEST(Exr, FloatRoundTripKeepsEveryBit) {
  const TempDir dir;
  Image image = RandomImage(17, 9, 1);
  image.At(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  image.At(1, 0)[1] = std::numeric_limits<float>::infinity();
  image.At(2, 0)[2] = -3.5f;
  image.At(3, 0)[0] = 1e30f;
  image.At(4, 0)[0] = 1e-40f;
  const std::string path = dir.File("a.exr");
  ASSERT_TRUE(WriteExr(image, path).ok());
  const StatusOr<Image> read = ReadExr(path);
  ASSERT_TRUE(read.ok()) << read.status().message();
  ExpectSameBits(image, *read);
  EXPECT_EQ(1, dir.CountFiles());
}

TEST(Exr, HalfRoundTripIsCloseAndClamped) {
  const TempDir dir;
  Image image = RandomImage(8, 5, 2);
  image.At(0, 0)[0] = 1e9f;
  image.At(0, 0)[1] = -1e9f;
  image.At(0, 0)[2] = std::numeric_limits<float>::infinity();
  const std::string path = dir.File("a.exr");
  ASSERT_TRUE(WriteExr(image, path, ExrPixelType::kHalf).ok());
  const StatusOr<Image> read = ReadExr(path);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(65504.0f, read->rgb[0]);
  EXPECT_EQ(-65504.0f, read->rgb[1]);
  EXPECT_TRUE(std::isinf(read->rgb[2]));
  for (size_t i = 3; i < image.rgb.size(); ++i) {
    EXPECT_NEAR(image.rgb[i], read->rgb[i], kHalfRelativeError * image.rgb[i]);
  }
}

TEST(Exr, ChannelsAreFoundByName) {
  const TempDir dir;
  const Image image = RandomImage(4, 3, 3);
  const std::string path = dir.File("a.exr");
  // Written in an order, and beside channels, that do not matter.
  WriteChannels(path, image,
                {{"B", 2}, {"A", 0}, {"R", 0}, {"Y", 1}, {"G", 1}});
  ExpectSameBits(image, ReadExr(path).value());
  WriteChannels(
      path, image,
      {{"diffuse.B", 2}, {"diffuse.R", 0}, {"diffuse.G", 1}, {"Z", 1}});
  ExpectSameBits(image, ReadExr(path).value());

  WriteChannels(path, image, {{"Y", 1}, {"Z", 0}});
  const Image grey = ReadExr(path).value();
  for (size_t i = 0; i < grey.rgb.size(); ++i) {
    EXPECT_EQ(image.rgb[i / 3 * 3 + 1], grey.rgb[i]);
  }
}

TEST(Exr, OtherChannelsAreRefusedAndListed) {
  const TempDir dir;
  const Image image = RandomImage(4, 3, 4);
  const std::string path = dir.File("a.exr");
  WriteChannels(path, image, {{"R", 0}, {"depth", 1}});
  const Status status = ReadExr(path).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find(path + ": channels"));
  EXPECT_NE(std::string::npos, status.message().find("R depth"));
  // Two layers with colours: which one is meant?
  WriteChannels(
      path, image,
      {{"a.R", 0}, {"a.G", 1}, {"a.B", 2}, {"b.R", 0}, {"b.G", 1}, {"b.B", 2}});
  EXPECT_FALSE(ReadExr(path).ok());
}

TEST(Exr, TiledFileWithOffsetDataWindow) {
  const TempDir dir;
  const Image image = RandomImage(37, 21, 5);
  const std::string path = dir.File("a.exr");
  const Imath::Box2i window({-5, 100}, {-5 + 36, 100 + 20});
  {
    Imf::Header header(Imath::Box2i({0, 0}, {999, 999}), window);
    header.setTileDescription(Imf::TileDescription(16, 8));
    for (const NamedChannel& c : kRgb) {
      header.channels().insert(c.name, Imf::Channel(Imf::FLOAT));
    }
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(FloatFrame(image, window, kRgb));
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const StatusOr<Image> read = ReadExr(path);
  ASSERT_TRUE(read.ok()) << read.status().message();
  ExpectSameBits(image, *read);
}

TEST(Exr, UintChannels) {
  const TempDir dir;
  const std::string path = dir.File("a.exr");
  const std::vector<uint32_t> values = {0, 1, 7, 1000, 65535, 1u << 24};
  {
    Imf::Header header(2, 1);
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < 3; ++c) {
      header.channels().insert(kRgb[c].name, Imf::Channel(Imf::UINT));
      frame.insert(
          kRgb[c].name,
          Imf::Slice::Make(Imf::UINT, values.data() + c, header.dataWindow(),
                           3 * sizeof(uint32_t), 6 * sizeof(uint32_t)));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(1);
  }
  const Image read = ReadExr(path).value();
  for (size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(static_cast<float>(values[i]), read.rgb[i]);
  }
}

TEST(Exr, FirstPartOfAMultiPartFile) {
  const TempDir dir;
  const std::string path = dir.File("a.exr");
  const Image images[] = {RandomImage(5, 4, 6), RandomImage(5, 4, 7)};
  {
    std::vector<Imf::Header> headers;
    for (const char* name : {"first", "second"}) {
      Imf::Header header(5, 4);
      header.setName(name);
      header.setType(Imf::SCANLINEIMAGE);
      for (const NamedChannel& c : kRgb) {
        header.channels().insert(c.name, Imf::Channel(Imf::FLOAT));
      }
      headers.push_back(header);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
    for (int p = 0; p < 2; ++p) {
      Imf::OutputPart part(file, p);
      part.setFrameBuffer(FloatFrame(images[p], headers[p].dataWindow(), kRgb));
      part.writePixels(4);
    }
  }
  ExpectSameBits(images[0], ReadExr(path).value());
}

TEST(Exr, OversizedHeaderFailsCleanly) {
  const TempDir dir;
  const std::string path = dir.File("a.exr");
  ASSERT_TRUE(WriteExr(RandomImage(16, 16, 8), path).ok());
  const std::string bytes = ReadBytes(path);
  const std::string attribute("dataWindow\0box2i\0", 17);
  const size_t at = bytes.find(attribute);
  ASSERT_NE(std::string::npos, at);
  const size_t max_corner = at + attribute.size() + 4 + 8;
  for (const int32_t x : {39999, 0x7ffffffe}) {
    for (const int32_t y : {15, 32767, 0x7ffffffe}) {
      std::string damaged = bytes;
      std::memcpy(&damaged[max_corner], &x, 4);
      std::memcpy(&damaged[max_corner + 4], &y, 4);
      WriteBytes(path, damaged);
      EXPECT_EQ(StatusCode::kInvalidInput, ReadExr(path).status().code())
          << x << " " << y;
    }
  }
  // Sides allowed, area not; then both allowed in a file far too small.
  for (const int32_t side : {32767, 4095}) {
    std::string damaged = bytes;
    std::memcpy(&damaged[max_corner], &side, 4);
    std::memcpy(&damaged[max_corner + 4], &side, 4);
    WriteBytes(path, damaged);
    EXPECT_EQ(StatusCode::kInvalidInput, ReadExr(path).status().code());
  }
}

// A valid image or a status, never a crash; damage may go unnoticed.
TEST(Exr, DamagedFiles) {
  const TempDir dir;
  const std::string path = dir.File("a.exr");
  const auto check = [&](const std::string& bytes) {
    const StatusOr<Image> read = DecodeExr(path, bytes);
    if (read.ok()) {
      EXPECT_EQ(read->num_pixels() * 3, read->rgb.size());
    } else {
      EXPECT_EQ(StatusCode::kInvalidInput, read.status().code());
      EXPECT_EQ(0u, read.status().message().find(path));
    }
  };
  const auto check_refused = [&](const std::string& bytes) {
    EXPECT_FALSE(DecodeExr(path, bytes).ok());
  };
  ASSERT_TRUE(WriteExr(RandomImage(33, 40, 9), path).ok());
  const std::string scanlines = ReadBytes(path);
  ForEachTruncation(scanlines, 100, check_refused);
  ForEachCorruption(scanlines, 400, 600, 10, check);
  {
    const Image image = RandomImage(40, 33, 11);
    Imf::Header header(40, 33);
    header.compression() = Imf::PIZ_COMPRESSION;
    header.setTileDescription(Imf::TileDescription(16, 16, Imf::MIPMAP_LEVELS));
    for (const NamedChannel& c : kRgb) {
      header.channels().insert(c.name, Imf::Channel(Imf::FLOAT));
    }
    Imf::TiledOutputFile file(path.c_str(), header);
    for (int level = 0; level < file.numLevels(); ++level) {
      file.setFrameBuffer(FloatFrame(image, header.dataWindow(), kRgb));
      file.writeTiles(0, file.numXTiles(level) - 1, 0,
                      file.numYTiles(level) - 1, level);
    }
  }
  const std::string tiles = ReadBytes(path);
  check(tiles);
  ForEachTruncation(tiles, 100, check);
  ForEachCorruption(tiles, 400, 600, 12, check);
}

TEST(Exr, WhatIsNotAFile) {
  const TempDir dir;
  EXPECT_EQ(StatusCode::kInvalidInput,
            ReadExr(dir.File("missing.exr")).status().code());
  EXPECT_FALSE(ReadExr(dir.path()).ok());
  WriteBytes(dir.File("empty.exr"), "");
  EXPECT_FALSE(ReadExr(dir.File("empty.exr")).ok());
  WriteBytes(dir.File("text.exr"), "this is not an image");
  EXPECT_FALSE(ReadExr(dir.File("text.exr")).ok());
}

TEST(Exr, WriterRefusesWhatItCannotWrite) {
  const TempDir dir;
  EXPECT_EQ(StatusCode::kInvalidInput,
            WriteExr(Image(2, 2), dir.File("none/a.exr")).code());
  EXPECT_EQ(StatusCode::kInternal, WriteExr(Image(), dir.File("a.exr")).code());
  Image inconsistent(2, 2);
  inconsistent.rgb.pop_back();
  EXPECT_EQ(StatusCode::kInternal,
            WriteExr(inconsistent, dir.File("a.exr")).code());
  EXPECT_EQ(0, dir.CountFiles());
}

}  // namespace
}  // namespace ibrdf
