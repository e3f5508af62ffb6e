// OpenEXR pictures as renderers and compositors write them.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// Any compression, scanlines or tiles (level 0), one part or many.
// - The picture is options.layer's, or the beauty part: exr_layers.h.
// - The image is the display window. Pixels of the data window outside of it
//   are cut, those that the data window lacks are 0 and not in has_data.
// - Chromaticities other than Rec. 709's are converted by RgbToRec709; negative
//   values may come of it, and are kept.
// - Y, RY, BY become R, G, B; chroma has every pixel or every second column and
//   row, filled in by OpenEXR's filter.
// - Normals (options.content): X Y Z or R G B, not converted.
// Refuses deep data, incomplete files and sizes over the limits, those of other
// parts and of OpenEXR's blocks too, before anything is allocated for them.
StatusOr<Photo> DecodeExrPhoto(const std::string& path,
                               const std::string& bytes,
                               const PhotoOptions& options);

}  // namespace ibrdf
