// Files of albedo.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// An image in any format of photo_file.h. Floats are as they stand, any number;
// whole numbers, as of a PNG, are linear and 1 at the largest.
StatusOr<Image> ReadAlbedo(const std::string& path);

}  // namespace ibrdf
