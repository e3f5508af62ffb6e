// OpenEXR files as other programs write them, for hard cases.
#pragma once
#include <yaml-cpp/yaml.h>

#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Writes an image into `path`. `exr`:
//   data_at: [x, y]          where the image lies in the display window; [0, 0]
//   display: [w, h]          that window; the image's size
//   aspect: a                pixelAspectRatio
//   chromaticities: [8 numbers]  of red, green, blue, white
//   channels: [R, G, B]      their names
//   layers: {name: factor}   a layer of each name, the image times factor
//   parts: {name: factor}    a part of each name
Status MakeExr(const YAML::Node& exr, const Image& image,
               const std::string& path);

}  // namespace ibrdf
