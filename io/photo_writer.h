// Photographs of codes as files, as cameras and renderers write them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace ibrdf {

// RGB codes in [0, 2^bits) [height, width, 3].
struct CodeImage {
  int width = 0, height = 0;
  int bits = 8;  // 1 to 16
  std::vector<uint16_t> rgb;
};

// The bytes of a PNG of 8 bits, of 16 where the codes have more than 8. Codes
// of fewer bits than the file's stand in its upper bits, repeated below, as
// sBIT says (PNG, section 12.4). Nothing in the file speaks of a curve.
std::string EncodeCodesAsPng(const CodeImage& codes);

// The bytes of a baseline JPEG, 8 bits, chroma of half size; quality 1 to 100.
std::string EncodeCodesAsJpeg(const CodeImage& codes, int quality);

}  // namespace ibrdf
