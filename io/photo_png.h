// PNG photographs.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// 1 to 16 bits; grey, RGB or palette (codes of 8 bits), interlaced or not. The
// codes stand as in the file, of 16 bits the most significant byte first.
// Alpha and tRNS become Photo::opaque. Read besides: gAMA, sRGB, cICP, iCCP,
// cHRM, sBIT, pHYs, eXIf. Of an animation the first picture is read.
// Refuses damaged files, and sizes over the limits before memory is taken.
StatusOr<Photo> DecodePngPhoto(const std::string& path,
                               const std::string& bytes,
                               const PhotoOptions& options);

}  // namespace ibrdf
