#include "ibrdf/io/png_memory.h"

#include <csetjmp>
#include <cstring>

#include "ibrdf/io/image_limits.h"

namespace ibrdf {
namespace {

// libpng allocates what an eXIf chunk claims before it reads it: every claim
// must fit into the file. Bytes after the last whole chunk are left to libpng.
bool ChunksFit(const PngReadState& state) {
  constexpr size_t kSignature = 8, kSizeAndType = 8, kChecksum = 4;
  size_t at = kSignature;
  while (state.size >= kSizeAndType && at <= state.size - kSizeAndType) {
    const png_uint_32 claim =
        png_get_uint_32(reinterpret_cast<png_const_bytep>(state.bytes + at));
    at += kSizeAndType;
    if (claim > state.size - at) return false;
    at += claim + kChecksum;
  }
  return true;
}

void ReadPngBytes(png_structp png, png_bytep out, size_t count) {
  PngReadState* state = static_cast<PngReadState*>(png_get_io_ptr(png));
  if (count > state->size - state->position) {
    png_error(png, "unexpected end of file");
  }
  std::memcpy(out, state->bytes + state->position, count);
  state->position += count;
}

// Deflate shrinks at most so many-fold (RFC 1951: 258 bytes in 2 bits).
constexpr size_t kMaxInflation = 1032;

// png_read_image and png_read_end. False on an error.
bool ReadRows(PngReadState* state, png_bytepp rows) {
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  png_read_image(state->png, rows);
  png_read_end(state->png, state->info);
  return true;
}

}  // namespace

void OnPngError(png_structp png, png_const_charp message) {
  char* buffer = static_cast<char*>(png_get_error_ptr(png));
  std::strncpy(buffer, message, 127);
  buffer[127] = '\0';
  png_longjmp(png, 1);
}

void OnPngWarning(png_structp, png_const_charp) {}

bool OpenPng(PngReadState* state) {
  const bool is_png =
      state->size >= 8 &&
      png_sig_cmp(reinterpret_cast<png_const_bytep>(state->bytes), 0, 8) == 0;
  if (is_png && !ChunksFit(*state)) {
    std::strncpy(state->message, "unexpected end of file",
                 sizeof(state->message) - 1);
    return false;
  }
  state->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, state->message,
                                      OnPngError, OnPngWarning);
  if (state->png == nullptr) return false;
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  state->info = png_create_info_struct(state->png);
  if (state->info == nullptr) return false;
  png_set_user_limits(state->png, kMaxImageSide, kMaxImageSide);
  png_set_read_fn(state->png, state, ReadPngBytes);
  return true;
}

StatusOr<std::vector<uint8_t>> ReadPngPixels(const std::string& path,
                                             size_t height, size_t row_bytes,
                                             size_t max_growth,
                                             PngReadState* state) {
  const size_t total = row_bytes * height;
  if (total / (kMaxInflation * max_growth) > state->size) {
    return InvalidInput(path, "truncated PNG, too few bytes for its size");
  }
  std::vector<uint8_t> pixels(total);
  std::vector<png_bytep> rows(height);
  for (size_t y = 0; y < height; ++y) rows[y] = pixels.data() + y * row_bytes;
  if (!ReadRows(state, rows.data())) return PngError(path, *state);
  return pixels;
}

Status PngError(const std::string& path, const PngReadState& state) {
  return InvalidInput(
      path, std::string("expected a PNG image (") + state.message + ")");
}

}  // namespace ibrdf
