#include "ibrdf/io/exif.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ibrdf {
namespace {

// EXIF 2.32, 4.6: tags and types.
enum Tag : uint32_t {
  kInteroperabilityIndex = 0x0001,
  kOrientation = 0x0112,
  kExposureTime = 0x829A,
  kFNumber = 0x829D,
  kExifTable = 0x8769,
  kIsoSpeed = 0x8827,
  kColourSpace = 0xA001,
  kInteroperabilityTable = 0xA005,
};
constexpr uint32_t kAscii = 2, kShort = 3, kLong = 4, kRational = 5;

constexpr size_t kEntryBytes = 12;

// Reads whole numbers of either byte order, as long as they lie in the block.
class ExifReader {
 public:
  explicit ExifReader(std::string_view block) : block_(block) {}

  ExifTags Read() {
    const bool little = block_.substr(0, 4) == std::string_view("II*\0", 4);
    const bool big = block_.substr(0, 4) == std::string_view("MM\0*", 4);
    big_endian_ = big;
    uint32_t first = 0;
    if ((!little && !big) || !Get(4, 4, &first)) {
      tags_.damaged = true;
      return tags_;
    }
    ReadTable(first, 0);
    return tags_;
  }

 private:
  bool Get(size_t at, size_t bytes, uint32_t* value) const {
    if (at > block_.size() || bytes > block_.size() - at) return false;
    *value = 0;
    for (size_t i = 0; i < bytes; ++i) {
      const size_t digit = big_endian_ ? i : bytes - 1 - i;
      *value = *value << 8 | static_cast<uint8_t>(block_[at + digit]);
    }
    return true;
  }

  // depth: tables within tables, so that a loop ends.
  void ReadTable(size_t at, int depth) {
    constexpr int kMaxTableDepth = 3;
    uint32_t count = 0;
    if (depth == kMaxTableDepth || !Get(at, 2, &count)) {
      tags_.damaged = true;
      return;
    }
    for (uint32_t i = 0; i < count; ++i) {
      const size_t entry = at + 2 + kEntryBytes * i;
      if (entry > block_.size() || kEntryBytes > block_.size() - entry) {
        tags_.damaged = true;
        return;
      }
      ReadEntry(entry, depth);
    }
  }

  void ReadEntry(size_t entry, int depth) {
    uint32_t tag = 0, type = 0, value = 0;
    Get(entry, 2, &tag);
    Get(entry + 2, 2, &type);
    Get(entry + 8, type == kShort ? 2 : 4, &value);
    const bool whole = type == kShort || type == kLong;
    if (tag == kExifTable || tag == kInteroperabilityTable) {
      if (type == kLong) ReadTable(value, depth + 1);
    } else if (tag == kOrientation && whole) {
      if (value >= 1 && value <= 8) {
        tags_.orientation = static_cast<int>(value);
      } else {
        tags_.damaged = true;
      }
    } else if (tag == kColourSpace && whole) {
      tags_.colour_space = static_cast<int>(value & 0xFFFF);
    } else if (tag == kIsoSpeed && whole && value > 0) {
      tags_.iso = value;
    } else if (tag == kInteroperabilityIndex && type == kAscii) {
      tags_.adobe_rgb |= block_.substr(entry + 8, 3) == "R03";
    } else if (tag == kExposureTime && type == kRational) {
      tags_.exposure_seconds = Rational(value);
    } else if (tag == kFNumber && type == kRational) {
      tags_.f_number = Rational(value);
    }
  }

  // Absent where it does not lie in the block or is not a number > 0.
  std::optional<double> Rational(size_t at) {
    uint32_t numerator = 0, denominator = 0;
    if (!Get(at, 4, &numerator) || !Get(at + 4, 4, &denominator)) {
      tags_.damaged = true;
      return std::nullopt;
    }
    if (numerator == 0 || denominator == 0) return std::nullopt;
    return static_cast<double>(numerator) / denominator;
  }

  const std::string_view block_;
  bool big_endian_ = false;
  ExifTags tags_;
};

}  // namespace

ExifTags ParseExif(std::string_view block) { return ExifReader(block).Read(); }

}  // namespace ibrdf
