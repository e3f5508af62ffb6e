// HDR images by file extension.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// .exr (io/exr.h) or .hdr (io/radiance_hdr.h), in any case; other extensions
// are refused. NaN, infinite and negative values are kept.
StatusOr<Image> ReadImage(const std::string& path);

// The same extensions; .exr as float, .hdr as RGBE. Whole or absent.
Status WriteImage(const Image& image, const std::string& path);

}  // namespace ibrdf
