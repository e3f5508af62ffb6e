// Sizes an image file may claim before anything is allocated for it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "ibrdf/base/status.h"

namespace ibrdf {

inline constexpr int64_t kMaxImageSide = 32768;
inline constexpr int64_t kMaxImagePixels = int64_t{1} << 26;
inline constexpr size_t kMaxImageFileBytes = size_t{1} << 30;

struct ImageLimits {
  int64_t side = kMaxImageSide;
  int64_t pixels = kMaxImagePixels;
};

// Ok when both sides are in [1, limits.side] and their product is at most
// limits.pixels; otherwise an error that names `path`.
Status CheckImageSize(const std::string& path, int64_t width, int64_t height,
                      const ImageLimits& limits = {});

// Ok when an image in memory has a size allowed above and `values` =
// 3 * width * height; otherwise kInternal (the caller's bug), naming `path`.
Status CheckWritable(const std::string& path, int width, int height,
                     size_t values);

}  // namespace ibrdf
