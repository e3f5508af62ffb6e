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

bool ReadPngRows(PngReadState* state, png_bytepp rows) {
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  png_read_image(state->png, rows);
  png_read_end(state->png, state->info);
  return true;
}

}  // namespace ibrdf
