#include "ibrdf/io/png.h"

#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <exception>
#include <new>
#include <vector>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/png_memory.h"

namespace ibrdf {
namespace {

struct ReadState : PngReadState {
  using PngReadState::PngReadState;

  png_uint_32 width = 0;
  png_uint_32 height = 0;
  size_t row_bytes = 0;  // four channels, 8 or 16 bits each
  bool sixteen_bits = false;
};

struct WriteState {
  std::string* bytes = nullptr;
  png_structp png = nullptr;
  png_infop info = nullptr;
  char message[128] = "";

  ~WriteState() { png_destroy_write_struct(&png, &info); }
};

void WriteBytes(png_structp png, png_bytep data, size_t count) {
  WriteState* state = static_cast<WriteState*>(png_get_io_ptr(png));
  bool appended = false;
  try {
    state->bytes->append(reinterpret_cast<const char*>(data), count);
    appended = true;
  } catch (const std::exception&) {
  }
  if (!appended) png_error(png, "out of memory");
}

void FlushBytes(png_structp) {}

// Reads the header and asks for four channels a pixel.
bool ReadHeader(ReadState* state) {
  if (!OpenPng(state)) return false;
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  png_read_info(state->png, state->info);
  state->width = png_get_image_width(state->png, state->info);
  state->height = png_get_image_height(state->png, state->info);
  state->sixteen_bits = png_get_bit_depth(state->png, state->info) == 16;
  png_set_expand(state->png);  // palette, bits < 8 and tRNS
  png_set_gray_to_rgb(state->png);
  png_set_add_alpha(state->png, 0xffff, PNG_FILLER_AFTER);
  png_set_interlace_handling(state->png);
  png_read_update_info(state->png, state->info);
  state->row_bytes = png_get_rowbytes(state->png, state->info);
  return png_get_channels(state->png, state->info) == 4;
}

bool WriteRows(WriteState* state, const Rgb8Image& image) {
  state->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, state->message,
                                       OnPngError, OnPngWarning);
  if (state->png == nullptr) return false;
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  state->info = png_create_info_struct(state->png);
  if (state->info == nullptr) return false;
  png_set_write_fn(state->png, state, WriteBytes, FlushBytes);
  png_set_IHDR(state->png, state->info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(state->png, state->info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(state->png, state->info);
  for (int y = 0; y < image.height; ++y) {
    png_write_row(state->png, image.At(0, y));
  }
  png_write_end(state->png, nullptr);
  return true;
}

StatusOr<Mask> DecodeOrThrow(const std::string& path, const std::string& bytes,
                             const ImageLimits& limits) {
  ReadState state(bytes);
  if (!ReadHeader(&state)) return PngError(path, state);
  IBRDF_RETURN_IF_ERROR(
      CheckImageSize(path, state.width, state.height, limits));
  // Expansion to four channels of 8 bits grows one-bit pixels 32-fold.
  const StatusOr<std::vector<uint8_t>> read =
      ReadPngPixels(path, state.height, state.row_bytes, 32, &state);
  if (!read.ok()) return read.status();
  const std::vector<uint8_t>& pixels = *read;

  Mask mask(static_cast<int>(state.width), static_cast<int>(state.height), 0);
  const size_t channel_bytes = state.sixteen_bits ? 2 : 1;
  const auto positive = [&](const uint8_t* pixel, size_t channel) {
    const uint8_t* value = pixel + channel * channel_bytes;
    return value[0] != 0 || (state.sixteen_bits && value[1] != 0);
  };
  for (size_t i = 0; i < mask.inside.size(); ++i) {
    const uint8_t* pixel = pixels.data() + i * 4 * channel_bytes;
    const bool lit =
        positive(pixel, 0) || positive(pixel, 1) || positive(pixel, 2);
    mask.inside[i] = lit && positive(pixel, 3) ? 1 : 0;
  }
  return mask;
}

}  // namespace

StatusOr<Mask> ReadMask(const std::string& path) {
  const StatusOr<std::string> bytes = ReadFile(path, kMaxImageFileBytes);
  if (!bytes.ok()) return bytes.status();
  return DecodeMask(path, *bytes);
}

StatusOr<Mask> DecodeMask(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits) {
  try {
    return DecodeOrThrow(path, bytes, limits);
  } catch (const std::bad_alloc&) {
    return InvalidInput(path, "expected an image that fits into memory");
  }
}

StatusOr<std::string> EncodePng(const Rgb8Image& image) {
  IBRDF_RETURN_IF_ERROR(
      CheckWritable("PNG", image.width, image.height, image.rgb.size()));
  std::string bytes;
  WriteState state;
  state.bytes = &bytes;
  if (!WriteRows(&state, image)) {
    return Status(StatusCode::kInternal,
                  std::string("PNG: cannot encode (") + state.message + ")");
  }
  return bytes;
}

Status WritePng(const Rgb8Image& image, const std::string& path) {
  const StatusOr<std::string> bytes = EncodePng(image);
  if (!bytes.ok()) {
    return Status(bytes.status().code(),
                  path + ": " + bytes.status().message());
  }
  return WriteFileAtomically(path, *bytes);
}

Status WriteMask(const Mask& mask, const std::string& path) {
  Rgb8Image picture(mask.width, mask.height);
  for (size_t k = 0; k < picture.rgb.size(); ++k) {
    picture.rgb[k] = mask.inside[k / 3] != 0 ? 255 : 0;
  }
  return WritePng(picture, path);
}

}  // namespace ibrdf
