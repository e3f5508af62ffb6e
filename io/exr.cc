#include "ibrdf/io/exr.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <utility>
#include <vector>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/exr_memory.h"

namespace ibrdf {
namespace {

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

// Before OpenEXR reads tables that grow with the size that the header claims.
Status CheckFirstHeader(const std::string& path, const std::string& bytes,
                        const ImageLimits& limits) {
  IBRDF_RETURN_IF_ERROR(CheckExrAttributes(path, bytes));
  if (bytes.size() < kExrHeaderStart) return OkStatus();
  ExrMemoryInput stream(path, bytes);
  stream.seekg(kExrHeaderStart);
  int version = ExrVersion(bytes);
  Imf::Header header;
  header.readFrom(stream, version);
  return CheckExrHeader(path, header, limits);
}

StatusOr<Image> Decode(const std::string& path, const std::string& bytes,
                       const ImageLimits& limits) {
  IBRDF_RETURN_IF_ERROR(CheckFirstHeader(path, bytes, limits));
  ExrMemoryInput stream(path, bytes);
  Imf::MultiPartInputFile file(stream, Imf::globalThreadCount(),
                               /*reconstructChunkOffsetTable=*/false);
  const Imf::Header& header = file.header(0);
  IBRDF_RETURN_IF_ERROR(CheckExrHeader(path, header, limits));
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

void AddAttributes(const ExrMapAttributes& attributes, Imf::Header* header) {
  if (attributes.envmap.has_value()) {
    Imf::addEnvmap(*header, *attributes.envmap == ExrEnvmap::kCube
                                ? Imf::ENVMAP_CUBE
                                : Imf::ENVMAP_LATLONG);
  }
  if (!attributes.map_frame.empty()) {
    header->insert(kMapFrameAttribute,
                   Imf::StringAttribute(attributes.map_frame));
  }
}

std::string Encode(const Image& image, const std::string& path,
                   ExrPixelType type, const ExrMapAttributes& attributes) {
  const bool half_floats = type == ExrPixelType::kHalf;
  const Imf::PixelType pixel_type = half_floats ? Imf::HALF : Imf::FLOAT;
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  AddAttributes(attributes, &header);
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

Status WriteExr(const Image& image, const std::string& path, ExrPixelType type,
                const ExrMapAttributes& attributes) {
  IBRDF_RETURN_IF_ERROR(
      CheckWritable(path, image.width, image.height, image.rgb.size()));
  std::string bytes;
  try {
    bytes = Encode(image, path, type, attributes);
  } catch (const std::exception& e) {
    return Status(StatusCode::kInternal,
                  path + ": cannot encode (" + std::string(e.what()) + ")");
  }
  return WriteFileAtomically(path, bytes);
}

}  // namespace ibrdf
