// Portable float maps.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// "PF" (RGB) or "Pf" (grey), rows from the bottom up, either byte order by the
// scale's sign. The scale's size, which most programs ignore, is not applied;
// a note says so where it is not 1. Refuses truncated files and sizes over the
// limits.
StatusOr<Photo> DecodePfm(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits);

}  // namespace ibrdf
