#include "io/mesh_precheck.h"

#include <cstdint>
#include <limits>
#include <sstream>

namespace ibrdf {
namespace {

// Bytes of a scalar type of PLY; 0 where unknown.
uint64_t PlyTypeBytes(const std::string& type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") {
    return 1;
  }
  if (type == "short" || type == "ushort" || type == "int16" ||
      type == "uint16") {
    return 2;
  }
  if (type == "int" || type == "uint" || type == "int32" || type == "uint32" ||
      type == "float" || type == "float32") {
    return 4;
  }
  if (type == "double" || type == "float64") return 8;
  return 0;
}

}  // namespace

Status PrecheckObj(const std::string& path, const std::string& bytes) {
  if (bytes.find('\0') != std::string::npos) {
    return InvalidInput(path, "expected text, found a zero byte");
  }
  for (size_t line = 0; line < bytes.size();) {
    size_t first = bytes.find_first_not_of(" \t", line);
    if (first == std::string::npos) break;
    if (bytes[first] == 'f' && first + 1 < bytes.size() &&
        (bytes[first + 1] == ' ' || bytes[first + 1] == '\t')) {
      return OkStatus();
    }
    const size_t newline = bytes.find('\n', first);
    if (newline == std::string::npos) break;
    line = newline + 1;
  }
  return InvalidInput(path + ": faces", "expected at least one face");
}

Status PrecheckPly(const std::string& path, const std::string& bytes) {
  const std::string where = path + ": header";
  if (bytes.compare(0, 4, "ply\n") != 0 && bytes.compare(0, 4, "ply\r") != 0) {
    return InvalidInput(path, "expected a PLY mesh, which starts \"ply\"");
  }
  constexpr char kEnd[] = "end_header";
  constexpr size_t kMaxHeaderBytes = 1 << 16;
  const size_t end = bytes.find(kEnd);
  if (end == std::string::npos || end > kMaxHeaderBytes) {
    return InvalidInput(where, "expected end_header");
  }
  const uint64_t left = bytes.size() - end - (sizeof(kEnd) - 1);
  std::istringstream header(bytes.substr(0, end));
  bool ascii = false, known_format = false, in_element = false;
  uint64_t needed = 0, count = 0;
  std::string line;
  while (std::getline(header, line)) {
    std::istringstream words(line);
    std::string keyword, type;
    words >> keyword;
    uint64_t property_bytes = 0;
    if (keyword == "format") {
      words >> type;
      ascii = type == "ascii";
      known_format = ascii || type == "binary_little_endian" ||
                     type == "binary_big_endian";
    } else if (keyword == "element") {
      int64_t elements = -1;
      words >> type >> elements;
      if (words.fail() || elements < 0 ||
          elements > std::numeric_limits<int32_t>::max()) {
        return InvalidInput(where,
                            "expected \"element name count\", count "
                            "from 0 to 2^31 - 1");
      }
      count = static_cast<uint64_t>(elements);
      in_element = true;
    } else if (keyword == "property") {
      words >> type;
      const bool list = type == "list";
      if (list) words >> type;  // of the count, at least 0 values follow
      property_bytes = PlyTypeBytes(type);
      if (!in_element || property_bytes == 0) {
        return InvalidInput(where, "expected a property of a known type");
      }
    }
    // A number takes one character or more and a space or the line's end; the
    // very last one may end with the file.
    needed += count * (property_bytes > 0 && ascii ? 2 : property_bytes);
    if (needed > left + 1) {
      return InvalidInput(where,
                          "element counts promise more than the file's " +
                              std::to_string(bytes.size()) + " bytes");
    }
  }
  if (!known_format) {
    return InvalidInput(where,
                        "expected format ascii, binary_little_endian or "
                        "binary_big_endian");
  }
  return OkStatus();
}

}  // namespace ibrdf
