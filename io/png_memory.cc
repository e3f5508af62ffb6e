#include "ibrdf/io/png_memory.h"

#include <csetjmp>
#include <cstring>

#include "ibrdf/io/image_limits.h"

namespace ibrdf {
namespace {

void ReadBytes(png_structp png, png_bytep out, size_t count) {
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
  state->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, state->message,
                                      OnPngError, OnPngWarning);
  if (state->png == nullptr) return false;
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  state->info = png_create_info_struct(state->png);
  if (state->info == nullptr) return false;
  png_set_user_limits(state->png, kMaxImageSide, kMaxImageSide);
  png_set_read_fn(state->png, state, ReadBytes);
  return true;
}

bool ReadPngRows(PngReadState* state, png_bytepp rows) {
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  png_read_image(state->png, rows);
  png_read_end(state->png, state->info);
  return true;
}

}  // namespace ibrdf
