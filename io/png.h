// PNG masks and previews.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/image_limits.h"

namespace ibrdf {

// Any PNG (1 to 16 bits; grey, RGB or palette; with or without alpha). A pixel
// is inside where a colour channel is > 0 and alpha (1 where absent) is > 0.
// Refuses damaged files and sizes over those of io/image_limits.h.
StatusOr<Mask> ReadMask(const std::string& path);

// The same of a file's bytes; messages call it `path`.
StatusOr<Mask> DecodeMask(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits = {});

// The bytes of an 8-bit RGB file. Sizes over those of io/image_limits.h are
// kInternal.
StatusOr<std::string> EncodePng(const Rgb8Image& image);

// Writes them. Whole or absent.
Status WritePng(const Rgb8Image& image, const std::string& path);

// White inside, black elsewhere.
Status WriteMask(const Mask& mask, const std::string& path);

}  // namespace ibrdf
