// What the sweep `photographs` makes of an image, and what the solver is told.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/response_curve.h"

namespace ibrdf {

enum class PhotographFile { kExr, kPng, kJpeg };

// What becomes of values at white.
enum class ClippedValues {
  kClipped,  // they are codes of white
  kData,     // an EXR says that they are white and no more
  kMissing,  // an EXR has no number there
};

struct PhotographSetting {
  std::string name;
  PhotographFile file = PhotographFile::kPng;
  int bits = 8;              // of a PNG
  int quality = 90;          // of a JPEG
  ResponseDefinition curve;  // that the file is written with
  // Share of the object's values that are white or more.
  double clipped = 0.0;
  ClippedValues values = ClippedValues::kClipped;
  std::string response;  // image.response of the problem file; empty: none
};

// `hdr`, the image as it is, is the first.
const std::vector<PhotographSetting>& PhotographSettings();

// The file of an image: radiance times the exposure that makes the brightest
// `clipped` share of the object's values white, by the curve, as codes. Writes
// it to `path`, which has the ending of ExtensionOf.
Status WritePhotograph(const PhotographSetting& setting, const Image& radiance,
                       const Mask& mask, const std::string& path);

// ".exr", ".png" or ".jpg".
std::string ExtensionOf(const PhotographSetting& setting);

}  // namespace ibrdf
