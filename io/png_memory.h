// libpng reading from memory.
#pragma once
#include <png.h>

#include <cstddef>
#include <string>

namespace ibrdf {

// libpng reports errors by longjmp, which must not skip a destructor: the
// functions that call setjmp own nothing, they work on the state of a caller.
struct PngReadState {
  const char* bytes = nullptr;
  size_t size = 0;
  size_t position = 0;
  png_structp png = nullptr;
  png_infop info = nullptr;
  char message[128] = "";  // of the last error

  // `file` outlives the state.
  explicit PngReadState(const std::string& file)
      : bytes(file.data()), size(file.size()) {}
  ~PngReadState() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReadState(const PngReadState&) = delete;
  PngReadState& operator=(const PngReadState&) = delete;
};

// Makes png and info; sides are limited to kMaxImageSide. False on an error, as
// of a chunk that claims more than the file has.
// The caller sets its own setjmp before it reads.
bool OpenPng(PngReadState* state);

// png_read_image and png_read_end. False on an error.
bool ReadPngRows(PngReadState* state, png_bytepp rows);

// For both directions; the error pointer is a buffer of 128 characters.
void OnPngError(png_structp png, png_const_charp message);
void OnPngWarning(png_structp png, png_const_charp message);

}  // namespace ibrdf
