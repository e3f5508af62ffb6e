// Radiance .hdr (RGBE) images.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/image_limits.h"

namespace ibrdf {

// Reads run-length encoded (new and old) and flat scanlines. A pixel is
// mantissa * 2^(exponent - 136), no half step added, divided by the product of
// the header's EXPOSURE and COLORCORR values, so that it is the radiance the
// header promises. Without a FORMAT line 32-bit_rle_rgbe is assumed.
// Refuses 32-bit_rle_xyze, orientations other than "-Y height +X width", and
// sizes over those of io/image_limits.h; the message names file and field.
StatusOr<Image> ReadRadianceHdr(const std::string& path);

// The same of a file's bytes; messages call it `path`.
StatusOr<Image> DecodeRadianceHdr(const std::string& path,
                                  const std::string& bytes,
                                  const ImageLimits& limits = {});

// 8-bit mantissas shared exponent (the largest channel is exact to 0.4 %).
// What the format cannot hold is replaced: NaN and negative values by 0, values
// over 1.7e38 by the largest it holds. Whole or absent.
Status WriteRadianceHdr(const Image& image, const std::string& path);

}  // namespace ibrdf
