// Photographs, renders and normal maps of any format that people bring.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// PNG, JPEG, TIFF, OpenEXR, Radiance HDR, PFM or .npy, by the first bytes, not
// by the name: photo_png.h, photo_jpeg.h, photo_tiff.h, photo_exr.h,
// radiance_hdr.h, pfm.h and npy.h say what of each is read. The values are
// those of the file, upright by EXIF; no curve is applied.
//
// Refused, with file and field: damaged and truncated files (never a part of a
// picture), sizes over options.limits (before memory is taken for them), other
// formats (HEIC, WebP, camera raw, ... by name), a `layer` of a format without
// layers, and as normals grey files and those with an EXIF orientation, whose
// directions nobody has turned.
StatusOr<Photo> ReadPhoto(const std::string& path,
                          const PhotoOptions& options = {});

// The same of a file's bytes; messages call it `path`.
StatusOr<Photo> DecodePhoto(const std::string& path, const std::string& bytes,
                            const PhotoOptions& options = {});

}  // namespace ibrdf
