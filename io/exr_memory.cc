#include "ibrdf/io/exr_memory.h"

#include <ImathBox.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string_view>

namespace ibrdf {
namespace {

uint32_t LittleEndian32(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) {
    value |= uint32_t{static_cast<uint8_t>(bytes[at + i])} << (8 * i);
  }
  return value;
}

// Whether OpenEXR, which goes by the type where that says how long a value is,
// reads all of `value` and no more.
bool SizeFitsType(const std::string& type, std::string_view value) {
  static const std::map<std::string, size_t> kBytes = {
      {"box2f", 16},   {"box2i", 16},      {"chromaticities", 32},
      {"double", 8},   {"compression", 1}, {"deepImageState", 1},
      {"envmap", 1},   {"float", 4},       {"int", 4},
      {"keycode", 28}, {"lineOrder", 1},   {"m33d", 72},
      {"m33f", 36},    {"m44d", 128},      {"m44f", 64},
      {"rational", 8}, {"tiledesc", 9},    {"timecode", 8},
      {"v2d", 16},     {"v2f", 8},         {"v2i", 8},
      {"v3d", 24},     {"v3f", 12},        {"v3i", 12}};
  if (type == "chlist") {  // names with 16 bytes each, then an empty name
    size_t at = 0;
    while (at < value.size() && value[at] != '\0') {
      at = std::min(value.find('\0', at), value.size()) + 17;
    }
    return at + 1 == value.size();
  }
  const auto bytes = kBytes.find(type);
  return bytes == kBytes.end() || bytes->second == value.size();
}

}  // namespace

bool ExrMemoryInput::read(char c[], int n) {
  if (n < 0 || position_ > bytes_.size() ||
      static_cast<size_t>(n) > bytes_.size() - position_) {
    throw std::runtime_error("unexpected end of file");
  }
  std::memcpy(c, bytes_.data() + position_, static_cast<size_t>(n));
  position_ += static_cast<size_t>(n);
  return position_ < bytes_.size();
}

int ExrVersion(const std::string& bytes) {
  return static_cast<int>(LittleEndian32(bytes, 4));
}

bool IsMultiPartExr(const std::string& bytes) {
  constexpr int kMultiPart = 0x1000;
  return (ExrVersion(bytes) & kMultiPart) != 0;
}

Status CheckExrAttributes(const std::string& path, const std::string& bytes) {
  if (bytes.size() < kExrHeaderStart) return OkStatus();
  const bool many = IsMultiPartExr(bytes);
  size_t at = kExrHeaderStart;
  bool header_is_empty = true;
  while (true) {
    const size_t name_end = bytes.find('\0', at);
    if (name_end == std::string::npos) return OkStatus();
    if (name_end == at) {  // the end of a header; an empty one is the last
      if (!many || header_is_empty) return OkStatus();
      header_is_empty = true;
      ++at;
      continue;
    }
    header_is_empty = false;
    const std::string name =
        bytes.substr(at, std::min(name_end - at, size_t{60}));
    const size_t type_end = bytes.find('\0', name_end + 1);
    if (type_end == std::string::npos || bytes.size() - type_end < 5) {
      return OkStatus();
    }
    const uint32_t size = LittleEndian32(bytes, type_end + 1);
    at = type_end + 5;
    if (size > bytes.size() - at) {
      return InvalidInput(path + ": attribute " + name,
                          "expected a size that fits into the file, found " +
                              std::to_string(size) + " bytes");
    }
    const std::string type =
        bytes.substr(name_end + 1, type_end - name_end - 1);
    if (!SizeFitsType(type, std::string_view(bytes).substr(at, size))) {
      return InvalidInput(path + ": attribute " + name,
                          "expected the size of its type, found " +
                              std::to_string(size) + " bytes");
    }
    at += size;
  }
}

Status CheckExrHeader(const std::string& path, const Imf::Header& header,
                      const ImageLimits& limits) {
  if (header.hasType() && !Imf::isImage(header.type())) {
    return InvalidInput(path + ": type",
                        "expected scanlines or tiles, found " + header.type());
  }
  const Imath::Box2i& window = header.dataWindow();
  IBRDF_RETURN_IF_ERROR(
      CheckImageSize(path, int64_t{window.max.x} - window.min.x + 1,
                     int64_t{window.max.y} - window.min.y + 1, limits));
  if (header.hasTileDescription()) {
    // OpenEXR allocates whole tiles, even of a small image.
    const Imf::TileDescription& tile = header.tileDescription();
    const Status status = CheckImageSize(path, tile.xSize, tile.ySize, limits);
    if (!status.ok()) {
      return InvalidInput(path + ": tile size",
                          "expected at most the limits of an image, found " +
                              std::to_string(tile.xSize) + "x" +
                              std::to_string(tile.ySize));
    }
  }
  return OkStatus();
}

}  // namespace ibrdf
