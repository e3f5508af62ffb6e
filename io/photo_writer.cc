#include "ibrdf/io/photo_writer.h"

#include <glog/logging.h>
#include <png.h>

// jpeglib.h needs FILE and size_t.
#include <cstdio>
// After it.
#include <jpeglib.h>

#include <cstdlib>

namespace ibrdf {
namespace {

void CheckCodes(const CodeImage& codes) {
  CHECK(codes.width > 0 && codes.height > 0);
  CHECK(codes.bits >= 1 && codes.bits <= 16);
  CHECK_EQ(codes.rgb.size(), size_t{3} * codes.width * codes.height);
  for (const uint16_t code : codes.rgb) CHECK_EQ(0, code >> codes.bits);
}

// A code of `bits` bits as one of `to` bits: its own bits again and again.
uint32_t Repeated(uint32_t code, int bits, int to) {
  uint32_t out = 0;
  for (int shift = to - bits; shift > -bits; shift -= bits) {
    out |= shift >= 0 ? code << shift : code >> -shift;
  }
  return out;
}

void FailPng(png_structp, png_const_charp message) {
  LOG(FATAL) << "PNG: " << message;
}

void AppendPngBytes(png_structp png, png_bytep data, size_t size) {
  auto* const bytes = static_cast<std::string*>(png_get_io_ptr(png));
  bytes->append(reinterpret_cast<const char*>(data), size);
}

void FailJpeg(j_common_ptr jpeg) {
  char message[JMSG_LENGTH_MAX];
  jpeg->err->format_message(jpeg, message);
  LOG(FATAL) << "JPEG: " << message;
}

}  // namespace

std::string EncodeCodesAsPng(const CodeImage& codes) {
  CheckCodes(codes);
  const int depth = codes.bits > 8 ? 16 : 8;
  std::string bytes;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, FailPng, nullptr);
  CHECK(png != nullptr);
  png_infop info = png_create_info_struct(png);
  CHECK(info != nullptr);
  png_set_write_fn(png, &bytes, AppendPngBytes, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(codes.width),
               static_cast<png_uint_32>(codes.height), depth,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (codes.bits < depth) {
    png_color_8 significant = {};
    significant.red = significant.green = significant.blue =
        static_cast<png_byte>(codes.bits);
    png_set_sBIT(png, info, &significant);
  }
  png_write_info(png, info);
  std::vector<png_byte> row;
  for (int y = 0; y < codes.height; ++y) {
    row.clear();
    for (int x = 0; x < 3 * codes.width; ++x) {
      const uint32_t code = Repeated(codes.rgb[size_t{3} * codes.width * y + x],
                                     codes.bits, depth);
      if (depth == 16) row.push_back(static_cast<png_byte>(code >> 8));
      row.push_back(static_cast<png_byte>(code & 0xFF));
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string EncodeCodesAsJpeg(const CodeImage& codes, int quality) {
  CheckCodes(codes);
  CHECK_EQ(8, codes.bits);
  CHECK(quality >= 1 && quality <= 100);
  jpeg_error_mgr errors;
  jpeg_compress_struct jpeg;
  jpeg.err = jpeg_std_error(&errors);
  errors.error_exit = FailJpeg;
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;  // NOLINT(runtime/int): libjpeg's type
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = static_cast<JDIMENSION>(codes.width);
  jpeg.image_height = static_cast<JDIMENSION>(codes.height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row(size_t{3} * codes.width);
  for (int y = 0; y < codes.height; ++y) {
    for (size_t x = 0; x < row.size(); ++x) {
      row[x] = static_cast<JSAMPLE>(codes.rgb[row.size() * y + x]);
    }
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&jpeg, rows, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  jpeg_destroy_compress(&jpeg);
  std::free(data);
  return bytes;
}

}  // namespace ibrdf
