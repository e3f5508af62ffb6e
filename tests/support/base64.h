// The inverse of io/html.h's Base64, by its definition.
#pragma once
#include <cstdint>
#include <string>

namespace ibrdf {

// Stops at padding; other characters count as zero.
inline std::string DecodeBase64(const std::string& text) {
  const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const size_t value = digits.find(c);
    bits = bits << 6 | static_cast<uint32_t>(value == digits.npos ? 0 : value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255u);
    }
  }
  return bytes;
}

}  // namespace ibrdf
