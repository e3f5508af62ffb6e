// NumPy arrays as pictures.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// .npy of versions 1 to 3: [height, width, 3] or [height, width], row 0 the
// top; uint8, uint16 (codes), float32 or float64, little endian, in C order.
// Values of float64 beyond floats become infinite. Refuses everything else, and
// files that are not exactly as long as their shape says.
StatusOr<Photo> DecodeNpy(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits);

}  // namespace ibrdf
