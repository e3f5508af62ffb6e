// Photographs for hard cases: codes in the files of cameras.
#pragma once
#include <yaml-cpp/yaml.h>

#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Writes an image as codes into `path`: .png, .jpg or .tif. `codes`:
//   curve: srgb, parameter: p     that radiance goes through
//   exposure: e                   that it is multiplied with before
//   bits: 8                       16: PNG, TIFF
//   code: c                       the same of all pixels, in place of radiance
//   grey: true, alpha: a          PNG: one channel; an alpha of a / 255
//   gamma: g, sbit: n, icc: text  PNG: gAMA; sBIT; a profile that is no profile
//   quality: q, cmyk: true        JPEG
//   orientation: n                JPEG, TIFF
//   cut: n, damage: n             bytes left; a byte that is changed
Status MakePhotograph(const YAML::Node& codes, const Image& image,
                      const std::string& path);

}  // namespace ibrdf
