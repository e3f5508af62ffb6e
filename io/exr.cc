#include "ibrdf/io/exr.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "ibrdf/io/atomic_file.h"

namespace ibrdf {
namespace {

// The file is held in memory, so every read is checked against its length.
class MemoryInput final : public Imf::IStream {
 public:
  MemoryInput(const std::string& path, const std::string& bytes)
      : Imf::IStream(path.c_str()), bytes_(bytes) {}

  bool read(char c[], int n) override {
    if (n < 0 || position_ > bytes_.size() ||
        static_cast<size_t>(n) > bytes_.size() - position_) {
      throw std::runtime_error("unexpected end of file");
    }
    std::memcpy(c, bytes_.data() + position_, static_cast<size_t>(n));
    position_ += static_cast<size_t>(n);
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  const std::string& bytes_;
  uint64_t position_ = 0;
};

class MemoryOutput final : public Imf::OStream {
 public:
  MemoryOutput(const std::string& path, std::string* bytes)
      : Imf::OStream(path.c_str()), bytes_(*bytes) {}

  void write(const char c[], int n) override {
    const size_t end = position_ + static_cast<size_t>(n);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, c, static_cast<size_t>(n));
    position_ = end;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

 private:
  std::string& bytes_;
  size_t position_ = 0;
};

bool Has(const Imf::ChannelList& channels, const std::string& name) {
  return channels.findChannel(name.c_str()) != nullptr;
}

// "layer." of every layer that has R, G, B (or Y where `grey`).
std::vector<std::string> LayersWithColour(const Imf::ChannelList& channels,
                                          bool grey) {
  std::vector<std::string> layers;
  const std::string last = grey ? ".Y" : ".R";
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const std::string name = it.name();
    if (name.size() <= 2 || name.substr(name.size() - 2) != last) continue;
    const std::string layer = name.substr(0, name.size() - 1);
    if (grey || (Has(channels, layer + "G") && Has(channels, layer + "B"))) {
      layers.push_back(layer);
    }
  }
  return layers;
}

// Names of the channels that hold red, green and blue (all the same for grey).
StatusOr<std::array<std::string, 3>> ColourChannels(
    const std::string& path, const Imf::ChannelList& channels) {
  using Names = std::array<std::string, 3>;
  if (Has(channels, "R") && Has(channels, "G") && Has(channels, "B")) {
    return Names{"R", "G", "B"};
  }
  if (Has(channels, "Y")) return Names{"Y", "Y", "Y"};
  const std::vector<std::string> colour = LayersWithColour(channels, false);
  if (colour.size() == 1) {
    return Names{colour[0] + "R", colour[0] + "G", colour[0] + "B"};
  }
  const std::vector<std::string> grey = LayersWithColour(channels, true);
  if (colour.empty() && grey.size() == 1) {
    return Names{grey[0] + "Y", grey[0] + "Y", grey[0] + "Y"};
  }
  std::string found;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    found += (found.empty() ? "" : " ") + std::string(it.name());
    if (found.size() > 500) {
      found += " ...";
      break;
    }
  }
  return InvalidInput(path + ": channels",
                      "expected R G B, or Y, or one layer that has them; "
                      "found: " +
                          (found.empty() ? std::string("none") : found));
}

Status CheckHeader(const std::string& path, const Imf::Header& header,
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

uint32_t LittleEndian32(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) {
    value |= uint32_t{static_cast<uint8_t>(bytes[at + i])} << (8 * i);
  }
  return value;
}

constexpr size_t kHeaderStart = 8;  // after the magic number and the version

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

// OpenEXR allocates what an attribute claims before it reads it: every claim
// must fit into the file. A header that is cut off is left to OpenEXR.
Status CheckAttributes(const std::string& path, const std::string& bytes) {
  constexpr uint32_t kMultiPart = 0x1000;
  if (bytes.size() < kHeaderStart) return OkStatus();
  const bool many = (LittleEndian32(bytes, 4) & kMultiPart) != 0;
  size_t at = kHeaderStart;
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

// Before OpenEXR reads tables that grow with the size that the header claims.
Status CheckFirstHeader(const std::string& path, const std::string& bytes,
                        const ImageLimits& limits) {
  IBRDF_RETURN_IF_ERROR(CheckAttributes(path, bytes));
  if (bytes.size() < kHeaderStart) return OkStatus();
  MemoryInput stream(path, bytes);
  stream.seekg(kHeaderStart);
  int version = static_cast<int>(LittleEndian32(bytes, 4));
  Imf::Header header;
  header.readFrom(stream, version);
  return CheckHeader(path, header, limits);
}

StatusOr<Image> Decode(const std::string& path, const std::string& bytes,
                       const ImageLimits& limits) {
  IBRDF_RETURN_IF_ERROR(CheckFirstHeader(path, bytes, limits));
  MemoryInput stream(path, bytes);
  Imf::MultiPartInputFile file(stream, Imf::globalThreadCount(),
                               /*reconstructChunkOffsetTable=*/false);
  const Imf::Header& header = file.header(0);
  IBRDF_RETURN_IF_ERROR(CheckHeader(path, header, limits));
  if (!file.partComplete(0)) {
    return InvalidInput(path, "incomplete file, expected all its pixels");
  }
  const StatusOr<std::array<std::string, 3>> names =
      ColourChannels(path, header.channels());
  if (!names.ok()) return names.status();
  for (const std::string& name : *names) {
    const Imf::Channel& channel = header.channels()[name.c_str()];
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      return InvalidInput(path + ": channel " + name,
                          "expected one sample a pixel, found subsampling");
    }
  }

  const Imath::Box2i window = header.dataWindow();
  Image image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
  constexpr size_t kPixelBytes = 3 * sizeof(float);
  const size_t row_bytes = kPixelBytes * static_cast<size_t>(image.width);
  const bool grey = (*names)[0] == (*names)[1];
  Imf::FrameBuffer frame;
  for (int c = 0; c < (grey ? 1 : 3); ++c) {
    frame.insert((*names)[c], Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + c,
                                               window, kPixelBytes, row_bytes));
  }
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
  if (grey) {
    for (size_t i = 0; i < image.rgb.size(); i += 3) {
      image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
    }
  }
  return image;
}

std::string Encode(const Image& image, const std::string& path,
                   ExrPixelType type) {
  const bool half_floats = type == ExrPixelType::kHalf;
  const Imf::PixelType pixel_type = half_floats ? Imf::HALF : Imf::FLOAT;
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  std::vector<half> halves;
  if (half_floats) {
    halves.reserve(image.rgb.size());
    for (const float v : image.rgb) {
      halves.emplace_back(std::isfinite(v) ? std::clamp(v, -65504.0f, 65504.0f)
                                           : v);
    }
  }
  const char* data = half_floats
                         ? reinterpret_cast<const char*>(halves.data())
                         : reinterpret_cast<const char*>(image.rgb.data());
  const size_t value_bytes = half_floats ? sizeof(half) : sizeof(float);
  Imf::FrameBuffer frame;
  const std::array<const char*, 3> names = {"R", "G", "B"};
  for (size_t c = 0; c < names.size(); ++c) {
    header.channels().insert(names[c], Imf::Channel(pixel_type));
    frame.insert(names[c],
                 Imf::Slice::Make(pixel_type, data + c * value_bytes,
                                  header.dataWindow(), 3 * value_bytes,
                                  3 * value_bytes * image.width));
  }
  std::string bytes;
  MemoryOutput stream(path, &bytes);
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }  // the destructor writes the line table
  return bytes;
}

}  // namespace

StatusOr<Image> ReadExr(const std::string& path) {
  const StatusOr<std::string> bytes = ReadFile(path, kMaxImageFileBytes);
  if (!bytes.ok()) return bytes.status();
  return DecodeExr(path, *bytes);
}

StatusOr<Image> DecodeExr(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits) {
  try {
    return Decode(path, bytes, limits);
  } catch (const std::exception& e) {
    return InvalidInput(
        path, std::string("expected an OpenEXR image (") + e.what() + ")");
  }
}

Status WriteExr(const Image& image, const std::string& path,
                ExrPixelType type) {
  IBRDF_RETURN_IF_ERROR(
      CheckWritable(path, image.width, image.height, image.rgb.size()));
  std::string bytes;
  try {
    bytes = Encode(image, path, type);
  } catch (const std::exception& e) {
    return Status(StatusCode::kInternal,
                  path + ": cannot encode (" + std::string(e.what()) + ")");
  }
  return WriteFileAtomically(path, bytes);
}

}  // namespace ibrdf
