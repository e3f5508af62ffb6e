// The checksum of a chunk of PNG.
#pragma once
#include <cstddef>
#include <cstdint>

namespace ibrdf {

// The checksum of `size` bytes, type and data of the chunk (ISO 3309, as in PNG
// 1.2, D).
inline uint32_t PngCrc(const char* bytes, size_t size) {
  uint32_t crc = 0xffffffffu;
  for (size_t i = 0; i < size; ++i) {
    crc ^= static_cast<uint8_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) {
      crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
    }
  }
  return ~crc;
}

}  // namespace ibrdf
