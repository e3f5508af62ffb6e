#include "ibrdf/io/png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/support/corruption.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

struct PngFormat {
  int colour_type;
  int bit_depth;
  int interlace = PNG_INTERLACE_NONE;
};

// `rows` hold packed samples as in the file. The palette is black, dark blue,
// black and white; tRNS makes its entry 3 transparent.
void WriteRaw(const std::string& path, int width, int height,
              const PngFormat& format, std::vector<std::vector<uint8_t>> rows,
              const std::vector<uint8_t>& palette_alpha = {}) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  CHECK(file != nullptr);
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, width, height, format.bit_depth, format.colour_type,
               format.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (format.colour_type == PNG_COLOR_TYPE_PALETTE) {
    const png_color palette[4] = {
        {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, {255, 255, 255}};
    png_set_PLTE(png, info, palette, 4);
    if (!palette_alpha.empty()) {
      png_set_tRNS(png, info, palette_alpha.data(),
                   static_cast<int>(palette_alpha.size()), nullptr);
    }
  }
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  for (std::vector<uint8_t>& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

std::vector<uint8_t> ReadInside(const std::string& path) {
  const StatusOr<Mask> mask = ReadMask(path);
  EXPECT_TRUE(mask.ok()) << mask.status().message();
  return mask.ok() ? mask->inside : std::vector<uint8_t>();
}

using Inside = std::vector<uint8_t>;

TEST(Png, MaskFromEveryKindOfPixel) {
  const TempDir dir;
  const std::string path = dir.File("m.png");
  WriteRaw(path, 3, 2, {PNG_COLOR_TYPE_GRAY, 8}, {{0, 1, 255}, {7, 0, 0}});
  EXPECT_EQ((Inside{0, 1, 1, 1, 0, 0}), ReadInside(path));
  // 16 bits: the low byte counts.
  WriteRaw(path, 3, 1, {PNG_COLOR_TYPE_GRAY, 16}, {{0, 0, 0, 1, 1, 0}});
  EXPECT_EQ((Inside{0, 1, 1}), ReadInside(path));
  WriteRaw(path, 8, 1, {PNG_COLOR_TYPE_GRAY, 1}, {{0xa1}});
  EXPECT_EQ((Inside{1, 0, 1, 0, 0, 0, 0, 1}), ReadInside(path));
  WriteRaw(path, 2, 1, {PNG_COLOR_TYPE_GRAY, 4}, {{0x10}});
  EXPECT_EQ((Inside{1, 0}), ReadInside(path));
  WriteRaw(path, 3, 1, {PNG_COLOR_TYPE_RGB, 8}, {{0, 0, 0, 0, 0, 1, 9, 0, 0}});
  EXPECT_EQ((Inside{0, 1, 1}), ReadInside(path));
  WriteRaw(path, 3, 1, {PNG_COLOR_TYPE_RGB_ALPHA, 8},
           {{9, 9, 9, 0, 0, 0, 0, 255, 0, 9, 0, 1}});
  EXPECT_EQ((Inside{0, 0, 1}), ReadInside(path));
  WriteRaw(path, 2, 1, {PNG_COLOR_TYPE_RGB_ALPHA, 16},
           {{0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9, 9, 9, 9, 0, 0}});
  EXPECT_EQ((Inside{1, 0}), ReadInside(path));
  WriteRaw(path, 3, 1, {PNG_COLOR_TYPE_GRAY_ALPHA, 8}, {{5, 5, 5, 0, 0, 5}});
  EXPECT_EQ((Inside{1, 0, 0}), ReadInside(path));
  WriteRaw(path, 4, 1, {PNG_COLOR_TYPE_PALETTE, 2}, {{0x1b}});
  EXPECT_EQ((Inside{0, 1, 0, 1}), ReadInside(path));
  WriteRaw(path, 4, 1, {PNG_COLOR_TYPE_PALETTE, 8}, {{0, 1, 2, 3}},
           {255, 255, 255, 0});
  EXPECT_EQ((Inside{0, 1, 0, 0}), ReadInside(path));
}

TEST(Png, InterlacedMask) {
  const TempDir dir;
  const std::string path = dir.File("m.png");
  std::mt19937 rng(1);
  std::vector<std::vector<uint8_t>> rows(13, std::vector<uint8_t>(11));
  Inside expected;
  for (auto& row : rows) {
    for (uint8_t& v : row) expected.push_back(v = rng() & 1);
  }
  WriteRaw(path, 11, 13, {PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_ADAM7}, rows);
  EXPECT_EQ(expected, ReadInside(path));
}

// Compared with libpng's own simplified reader.
TEST(Png, WrittenPixelsAreReadBackByLibpng) {
  const TempDir dir;
  const std::string path = dir.File("a.png");
  std::mt19937 rng(2);
  Rgb8Image image(19, 7);
  for (uint8_t& v : image.rgb) v = static_cast<uint8_t>(rng());
  ASSERT_TRUE(WritePng(image, path).ok());
  EXPECT_EQ(1, dir.CountFiles());
  png_image control;
  std::memset(&control, 0, sizeof(control));
  control.version = PNG_IMAGE_VERSION;
  ASSERT_NE(0, png_image_begin_read_from_file(&control, path.c_str()));
  control.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> read(PNG_IMAGE_SIZE(control));
  ASSERT_NE(0,
            png_image_finish_read(&control, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(19u, control.width);
  EXPECT_EQ(image.rgb, read);
}

TEST(Png, OversizedHeaderFailsCleanly) {
  const TempDir dir;
  const std::string path = dir.File("m.png");
  // A file made of a header alone; the checksum has to be right.
  for (const auto& [width, height] :
       std::vector<std::pair<uint32_t, uint32_t>>{{32768, 32768},
                                                  {40000, 1},
                                                  {0x7fffffff, 0x7fffffff},
                                                  {8192, 8192},
                                                  {0, 1}}) {
    std::string chunk = "IHDR";
    for (const uint32_t v : {width, height}) {
      for (int shift = 24; shift >= 0; shift -= 8) {
        chunk.push_back(static_cast<char>(v >> shift));
      }
    }
    chunk += std::string("\x10\x06\0\0\0", 5);
    uint32_t crc = 0xffffffffu;
    for (const char c : chunk) {
      crc ^= static_cast<uint8_t>(c);
      for (int k = 0; k < 8; ++k)
        crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0);
    }
    crc = ~crc;
    std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\x0d", 12);
    bytes += chunk;
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes.push_back(static_cast<char>(crc >> shift));
    }
    // Start of an empty IDAT, so that the header is complete.
    bytes += std::string("\0\0\0\x10IDAT", 8);
    WriteBytes(path, bytes);
    const Status status = ReadMask(path).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << width;
    EXPECT_EQ(0u, status.message().find(path));
  }
}

TEST(Png, DamagedFiles) {
  const TempDir dir;
  const std::string path = dir.File("m.png");
  const auto check = [&](const std::string& bytes) {
    const StatusOr<Mask> read = DecodeMask(path, bytes);
    if (read.ok()) {
      EXPECT_EQ(static_cast<size_t>(read->width) * read->height,
                read->inside.size());
    } else {
      EXPECT_EQ(StatusCode::kInvalidInput, read.status().code());
    }
  };
  const auto check_refused = [&](const std::string& bytes) {
    EXPECT_FALSE(DecodeMask(path, bytes).ok());
  };
  Rgb8Image image(30, 20);
  std::mt19937 rng(3);
  for (uint8_t& v : image.rgb) v = static_cast<uint8_t>(rng() % 3);
  ASSERT_TRUE(WritePng(image, path).ok());
  const std::string rgb = ReadBytes(path);
  ForEachTruncation(rgb, 200, check_refused);
  ForEachCorruption(rgb, 64, 1000, 4, check);
  WriteRaw(path, 4, 1, {PNG_COLOR_TYPE_PALETTE, 8, PNG_INTERLACE_ADAM7},
           {{0, 1, 2, 3}}, {255, 255, 255, 0});
  const std::string palette = ReadBytes(path);
  ForEachTruncation(palette, 100, check_refused);
  ForEachCorruption(palette, 64, 1000, 5, check);
}

TEST(Png, WhatIsNotAFileAndWhatCannotBeWritten) {
  const TempDir dir;
  EXPECT_FALSE(ReadMask(dir.File("missing.png")).ok());
  EXPECT_FALSE(ReadMask(dir.path()).ok());
  WriteBytes(dir.File("empty.png"), "");
  EXPECT_FALSE(ReadMask(dir.File("empty.png")).ok());
  WriteBytes(dir.File("jpeg.png"), "\xff\xd8\xff\xe0 no png");
  const Status status = ReadMask(dir.File("jpeg.png")).status();
  EXPECT_NE(std::string::npos,
            status.message().find("jpeg.png: expected a PNG image"));
  EXPECT_EQ(StatusCode::kInvalidInput,
            WritePng(Rgb8Image(2, 2), dir.File("none/a.png")).code());
  EXPECT_EQ(StatusCode::kInternal,
            WritePng(Rgb8Image(), dir.File("a.png")).code());
  EXPECT_EQ(2, dir.CountFiles());
}

}  // namespace
}  // namespace ibrdf
