// The EXIF tags that matter for a picture's pixels.
#pragma once
#include <optional>
#include <string_view>

namespace ibrdf {

struct ExifTags {
  int orientation = 1;              // 1 to 8; 1 where absent or out of range
  std::optional<int> colour_space;  // tag 0xA001
  bool adobe_rgb = false;           // interoperability index R03
  std::optional<double> exposure_seconds, f_number, iso;
  // A table that does not fit into the block, or an orientation that there is
  // not. What came before it is kept.
  bool damaged = false;
};

// `block`: a TIFF header and its tables, as in JPEG's APP1 after "Exif\0\0", in
// PNG's eXIf, or a whole TIFF file. Any bytes are taken.
ExifTags ParseExif(std::string_view block);

}  // namespace ibrdf
