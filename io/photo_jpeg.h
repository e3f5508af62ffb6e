// JPEG photographs.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// Baseline and progressive files of 8 bits, grey or YCbCr or RGB, as codes.
// Read besides: EXIF, the ICC profile, JFIF's density.
// Refuses by name: CMYK and YCCK, 12 bits, lossless and arithmetic-coded files
// that the library lacks. Data that libjpeg would mend (truncated, bad codes)
// are an error; bytes too many between markers are not. Sizes over the limits,
// and more than 100 scans, are refused before memory or time is taken.
StatusOr<Photo> DecodeJpegPhoto(const std::string& path,
                                const std::string& bytes,
                                const PhotoOptions& options);

}  // namespace ibrdf
