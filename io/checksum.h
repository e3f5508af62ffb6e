// Checksum that ends our own binary files.
#pragma once
#include <cstddef>
#include <cstdint>

namespace ibrdf {

// FNV-1a of 64 bits: finds damage, not forgery.
inline uint64_t Fnv1a(const char* data, size_t size) {
  uint64_t hash = 0xcbf29ce484222325ULL;
  for (size_t i = 0; i < size; ++i) {
    hash = (hash ^ static_cast<unsigned char>(data[i])) * 0x100000001b3ULL;
  }
  return hash;
}

}  // namespace ibrdf
