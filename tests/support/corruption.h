// Damaged copies of a valid file.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <string>

namespace ibrdf {

// Calls read(copy) for truncated copies of `bytes`: every length up to 64, and
// `count` others, never the whole.
inline void ForEachTruncation(
    const std::string& bytes, int count,
    const std::function<void(const std::string&)>& read) {
  for (size_t n = 0; n < bytes.size() && n < 64; ++n) read(bytes.substr(0, n));
  for (int i = 0; i < count; ++i) {
    read(bytes.substr(0, bytes.size() * i / count));
  }
  read(bytes.substr(0, bytes.size() - 1));
}

// Calls read(copy) for copies of `bytes` with one to four bytes replaced, half
// of the time within the first `header_bytes`.
inline void ForEachCorruption(
    const std::string& bytes, size_t header_bytes, int count, uint32_t seed,
    const std::function<void(const std::string&)>& read) {
  std::mt19937 rng(seed);
  const auto below = [&](size_t n) { return rng() % n; };
  for (int i = 0; i < count; ++i) {
    std::string damaged = bytes;
    const size_t changes = 1 + below(4);
    for (size_t k = 0; k < changes; ++k) {
      const size_t range =
          i % 2 == 0 ? std::min(header_bytes, bytes.size()) : bytes.size();
      // Extreme values find more than uniform ones.
      const uint8_t extremes[] = {0x00, 0x7f, 0x80, 0xff};
      const size_t choice = below(8);
      damaged[below(range)] = static_cast<char>(
          choice < 4 ? extremes[choice] : static_cast<uint8_t>(below(256)));
    }
    read(damaged);
  }
}

}  // namespace ibrdf
