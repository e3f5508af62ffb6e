// libpng reading from memory.
#pragma once
#include <png.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

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

// The pixels [height][row_bytes] of a picture whose header was read. Expansion
// grows pixels at most max_growth-fold; a file too short for them is refused
// before memory is taken.
StatusOr<std::vector<uint8_t>> ReadPngPixels(const std::string& path,
                                             size_t height, size_t row_bytes,
                                             size_t max_growth,
                                             PngReadState* state);

// The state's error.
Status PngError(const std::string& path, const PngReadState& state);

// For both directions; the error pointer is a buffer of 128 characters.
void OnPngError(png_structp png, png_const_charp message);
void OnPngWarning(png_structp png, png_const_charp message);

}  // namespace ibrdf
