// TIFF photographs.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// The first picture of a file that is no thumbnail. Grey (black or white is 0)
// or RGB of 8 or 16 bits, palettes, grey of 1, 2 or 4 bits, floats of 16, 32
// or 64 bits; strips or tiles, interleaved channels or planes; no compression,
// LZW, Deflate, PackBits, Zstandard or JPEG. Read besides: alpha, orientation,
// resolution, the ICC profile, EXIF. White-is-0 codes are turned round.
// Refuses by name: CMYK, CIE Lab, YCbCr outside JPEG, raw sensor data, signed
// numbers, other bits (10, 12, 14, 24, 32) and compressions. Data that libtiff
// would mend are an error. Sizes over the limits, of strips and tiles too, are
// refused before memory is taken.
StatusOr<Photo> DecodeTiffPhoto(const std::string& path,
                                const std::string& bytes,
                                const PhotoOptions& options);

}  // namespace ibrdf
