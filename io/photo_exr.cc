#include "ibrdf/io/photo_exr.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfCompression.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfTileDescription.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <exception>

#include "ibrdf/io/chromaticities.h"
#include "ibrdf/io/exr_chroma.h"
#include "ibrdf/io/exr_layers.h"
#include "ibrdf/io/exr_memory.h"

namespace ibrdf {
namespace {

constexpr size_t kMaxParts = 256;
// What OpenEXR may allocate for one block of lines or one tile of all channels
// of a part. A line of 8192 pixels of 100 float channels has 3.3 MB; 256 lines
// of it (DWAB) 0.84 GB.
constexpr int64_t kMaxExrBlockBytes = int64_t{1} << 30;

int Width(const Imath::Box2i& window) {
  return window.max.x - window.min.x + 1;
}
int Height(const Imath::Box2i& window) {
  return window.max.y - window.min.y + 1;
}

Status CheckWindow(const std::string& where, const Imath::Box2i& window,
                   const ImageLimits& limits) {
  return CheckImageSize(where, int64_t{window.max.x} - window.min.x + 1,
                        int64_t{window.max.y} - window.min.y + 1, limits);
}

// Lines that a compression packs together (OpenEXR file layout).
int64_t LinesOfBlock(Imf::Compression compression) {
  switch (compression) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 1;
  }
}

// Blocks and tables that OpenEXR allocates for a part when it opens the file.
Status CheckBlocks(const std::string& path, const Imf::Header& header,
                   size_t file_bytes) {
  int64_t pixel_bytes = 0;
  const Imf::ChannelList& channels = header.channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    pixel_bytes += it.channel().type == Imf::HALF ? 2 : 4;
  }
  const int64_t width = Width(header.dataWindow());
  const int64_t height = Height(header.dataWindow());
  int64_t block = width * std::min(height, LinesOfBlock(header.compression()));
  int64_t blocks = 0;
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    const int64_t x = tile.xSize, y = tile.ySize;
    if (x < 1 || y < 1) {
      return InvalidInput(path + ": tile size", "expected 1 pixel or more");
    }
    block = x * y;
    blocks = ((width + x - 1) / x) * ((height + y - 1) / y);
  }
  if (block > kMaxExrBlockBytes / std::max<int64_t>(pixel_bytes, 1)) {
    return InvalidInput(path + ": channels",
                        "expected blocks of at most 1 GiB, found " +
                            std::to_string(block) + " pixels of " +
                            std::to_string(pixel_bytes) + " bytes");
  }
  constexpr size_t kOffsetBytes = 8;
  if (static_cast<size_t>(blocks) > file_bytes / kOffsetBytes) {
    return InvalidInput(path, "truncated, too few bytes for its " +
                                  std::to_string(blocks) + " tiles");
  }
  return OkStatus();
}

// Every header, before OpenEXR reads tables that grow with what they claim.
StatusOr<std::vector<Imf::Header>> ReadHeaders(const std::string& path,
                                               const std::string& bytes,
                                               const ImageLimits& limits) {
  if (bytes.size() < kExrHeaderStart) {
    return InvalidInput(path, "truncated OpenEXR header");
  }
  IBRDF_RETURN_IF_ERROR(CheckExrAttributes(path, bytes));
  ExrMemoryInput stream(path, bytes);
  stream.seekg(kExrHeaderStart);
  const bool many = IsMultiPartExr(bytes);
  std::vector<Imf::Header> headers;
  while (true) {
    if (many && stream.tellg() < bytes.size() &&
        bytes[stream.tellg()] == '\0') {
      break;  // an empty header is the last
    }
    if (headers.size() == kMaxParts) {
      return InvalidInput(path + ": parts", "expected at most 256");
    }
    int version = ExrVersion(bytes);
    headers.emplace_back();
    Imf::Header& header = headers.back();
    header.readFrom(stream, version);
    IBRDF_RETURN_IF_ERROR(CheckWindow(path, header.dataWindow(), limits));
    if (!many || !header.hasType() || Imf::isImage(header.type())) {
      IBRDF_RETURN_IF_ERROR(CheckExrHeader(path, header, limits));
    }
    IBRDF_RETURN_IF_ERROR(CheckBlocks(path, header, bytes.size()));
    if (!many) break;
  }
  if (headers.empty()) return InvalidInput(path, "expected a part, found none");
  return headers;
}

// One sample a pixel, or chroma of every second column and row.
Status CheckSampling(const std::string& path, const ExrPicture& picture,
                     const Imf::Header& header) {
  for (size_t c = 0; c < 3; ++c) {
    const Imf::Channel& channel =
        header.channels()[picture.channels[c].c_str()];
    const bool chroma = picture.kind == ExrChannels::kLuminanceChroma && c > 0;
    const bool full = channel.xSampling == 1 && channel.ySampling == 1;
    const bool half = channel.xSampling == 2 && channel.ySampling == 2;
    if (full || (chroma && half)) continue;
    return InvalidInput(path + ": channel " + picture.channels[c],
                        "expected one sample a pixel" +
                            std::string(chroma ? " or four pixels" : "") +
                            ", found other subsampling");
  }
  return OkStatus();
}

// The samples of one channel of the data window.
std::vector<float> NewPlane(const Imath::Box2i& window, int sampling) {
  return std::vector<float>(
      static_cast<size_t>((Width(window) + sampling - 1) / sampling) *
      static_cast<size_t>((Height(window) + sampling - 1) / sampling));
}

void InsertPlane(const std::string& name, const Imath::Box2i& window,
                 int sampling, std::vector<float>* plane,
                 Imf::FrameBuffer* frame) {
  const size_t row =
      sizeof(float) *
      static_cast<size_t>((Width(window) + sampling - 1) / sampling);
  frame->insert(name, Imf::Slice::Make(Imf::FLOAT, plane->data(), window,
                                       sizeof(float), row, sampling, sampling));
}

struct WindowPixels {
  Image image;               // of the data window
  std::vector<float> alpha;  // empty where there is none
};

// chroma: RY and BY, with every second column and row or with all.
void AddChroma(const Imath::Box2i& window, int sampling,
               const std::array<std::vector<float>, 2>& chroma,
               const Eigen::Vector3d& weights, Image* image) {
  std::array<std::vector<float>, 2> full;
  for (size_t k = 0; k < 2; ++k) {
    full[k] = sampling == 1
                  ? chroma[k]
                  : UpsampleChroma(chroma[k], Width(window), Height(window));
  }
  for (size_t i = 0; i < image->num_pixels(); ++i) {
    LuminanceChromaToRgb(image->rgb[3 * i], full[0][i], full[1][i], weights,
                         &image->rgb[3 * i]);
  }
}

WindowPixels ReadWindow(Imf::MultiPartInputFile* file,
                        const ExrPicture& picture, const Imf::Header& header,
                        const Eigen::Vector3d& weights) {
  const Imath::Box2i window = header.dataWindow();
  WindowPixels pixels;
  pixels.image = Image(Width(window), Height(window));
  constexpr size_t kPixelBytes = 3 * sizeof(float);
  const size_t row_bytes = kPixelBytes * static_cast<size_t>(Width(window));
  Imf::FrameBuffer frame;
  const bool colour =
      picture.kind == ExrChannels::kRgb || picture.kind == ExrChannels::kXyz;
  for (size_t c = 0; c < (colour ? 3 : 1); ++c) {
    frame.insert(picture.channels[c],
                 Imf::Slice::Make(Imf::FLOAT, pixels.image.rgb.data() + c,
                                  window, kPixelBytes, row_bytes));
  }
  std::array<std::vector<float>, 2> chroma;
  int sampling = 1;
  if (picture.kind == ExrChannels::kLuminanceChroma) {
    sampling = header.channels()[picture.channels[1].c_str()].xSampling;
    for (size_t k = 0; k < 2; ++k) {
      chroma[k] = NewPlane(window, sampling);
      InsertPlane(picture.channels[k + 1], window, sampling, &chroma[k],
                  &frame);
    }
  }
  if (!picture.alpha.empty()) {
    pixels.alpha = NewPlane(window, 1);
    InsertPlane(picture.alpha, window, 1, &pixels.alpha, &frame);
  }
  Imf::InputPart part(*file, picture.part);
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
  std::vector<float>& rgb = pixels.image.rgb;
  if (picture.kind == ExrChannels::kGrey) {
    for (size_t i = 0; i < rgb.size(); i += 3) rgb[i + 1] = rgb[i + 2] = rgb[i];
  } else if (picture.kind == ExrChannels::kLuminanceChroma) {
    AddChroma(window, sampling, chroma, weights, &pixels.image);
  }
  return pixels;
}

std::string WindowText(const Imath::Box2i& window) {
  return std::to_string(Width(window)) + "x" + std::to_string(Height(window)) +
         " at (" + std::to_string(window.min.x) + ", " +
         std::to_string(window.min.y) + ")";
}

// Places the data window's pixels in the display window.
Status PlaceInDisplay(const std::string& path, const Imf::Header& header,
                      WindowPixels pixels, Photo* photo) {
  const Imath::Box2i& data = header.dataWindow();
  const Imath::Box2i& display = header.displayWindow();
  if (data == display) {
    photo->image = std::move(pixels.image);
    if (!pixels.alpha.empty()) SetAlpha(pixels.alpha, photo);
    return OkStatus();
  }
  const Imath::Box2i both({std::max(data.min.x, display.min.x),
                           std::max(data.min.y, display.min.y)},
                          {std::min(data.max.x, display.max.x),
                           std::min(data.max.y, display.max.y)});
  if (both.isEmpty()) {
    return InvalidInput(path + ": dataWindow",
                        "expected pixels in the display window " +
                            WindowText(display) + ", found " +
                            WindowText(data));
  }
  photo->image = Image(Width(display), Height(display));
  Mask covered(Width(display), Height(display), 0);
  // No opinion where there is no data: has_data says it.
  std::vector<float> alpha(pixels.alpha.empty() ? 0 : covered.inside.size(),
                           1.0f);
  for (int y = both.min.y; y <= both.max.y; ++y) {
    for (int x = both.min.x; x <= both.max.x; ++x) {
      const size_t from =
          static_cast<size_t>(y - data.min.y) * Width(data) + (x - data.min.x);
      const size_t to =
          static_cast<size_t>(y - display.min.y) * Width(display) +
          (x - display.min.x);
      std::copy_n(&pixels.image.rgb[3 * from], 3, &photo->image.rgb[3 * to]);
      covered.inside[to] = 1;
      if (!alpha.empty()) alpha[to] = pixels.alpha[from];
    }
  }
  if (!alpha.empty()) SetAlpha(alpha, photo);
  const bool whole = both == display;
  photo->notes.push_back("The data window, " + WindowText(data) +
                         ", is not the display window, " + WindowText(display) +
                         ": the image is the display window" +
                         (whole ? "." : ", with pixels missing."));
  if (!whole) photo->has_data = std::move(covered);
  return OkStatus();
}

// What the header says of an environment map's frame.
void ReadMapAttributes(const Imf::Header& header, Photo* photo) {
  if (Imf::hasEnvmap(header)) {
    switch (Imf::envmap(header)) {
      case Imf::ENVMAP_LATLONG:
        photo->envmap = ExrEnvmap::kLatLong;
        break;
      case Imf::ENVMAP_CUBE:
        photo->envmap = ExrEnvmap::kCube;
        break;
      default:
        photo->notes.emplace_back(
            "The attribute envmap is neither latlong nor cube; it was "
            "ignored.");
    }
  }
  const auto* frame =
      header.findTypedAttribute<Imf::StringAttribute>(kMapFrameAttribute);
  if (frame != nullptr) photo->map_frame = Printable(frame->value());
}

PrimaryColours FilePrimaries(const Imf::Header& header) {
  PrimaryColours primaries;
  if (!Imf::hasChromaticities(header)) return primaries;
  const Imf::Chromaticities& c = Imf::chromaticities(header);
  primaries.red = {c.red.x, c.red.y};
  primaries.green = {c.green.x, c.green.y};
  primaries.blue = {c.blue.x, c.blue.y};
  primaries.white = {c.white.x, c.white.y};
  return primaries;
}

struct ColourSpace {
  Eigen::Vector3d luminance = Eigen::Vector3d::Zero();  // of R, G and B
  std::optional<Eigen::Matrix3d> to_rec709;             // absent: it is that
};

StatusOr<ColourSpace> FileColours(const std::string& path,
                                  const Imf::Header& header,
                                  const ExrPicture& picture,
                                  PhotoContent content) {
  ColourSpace colours;
  if (content != PhotoContent::kColour || picture.kind == ExrChannels::kGrey) {
    return colours;
  }
  const PrimaryColours primaries = FilePrimaries(header);
  const std::optional<Eigen::Matrix3d> to_xyz = RgbToXyz(primaries);
  const std::optional<Eigen::Matrix3d> to_rec709 = RgbToRec709(primaries);
  constexpr double kMinWeight = 1e-6;  // green is the rest of the luminance
  if (!to_xyz || !to_rec709 ||
      (picture.kind == ExrChannels::kLuminanceChroma &&
       !(std::fabs((*to_xyz)(1, 1)) > kMinWeight))) {
    return InvalidInput(path + ": chromaticities",
                        "expected three primaries and a white that span a "
                        "colour space");
  }
  colours.luminance = to_xyz->row(1);
  if (!AreSamePrimaries(primaries, PrimaryColours())) {
    colours.to_rec709 = *to_rec709;
  }
  return colours;
}

void ConvertColours(const Eigen::Matrix3d& to_rec709, Photo* photo) {
  size_t negative = 0;
  for (size_t i = 0; i < photo->image.rgb.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> rgb(&photo->image.rgb[i]);
    const bool positive = (rgb.array() >= 0.0f).all();
    rgb = (to_rec709 * rgb.cast<double>()).cast<float>();
    negative += positive && (rgb.array() < 0.0f).any();
  }
  photo->notes.push_back(
      "Colours were converted from the file's chromaticities to the primaries "
      "of Rec. 709" +
      (negative == 0 ? "."
                     : "; " + std::to_string(negative) +
                           " pixels have colours outside of them, thus "
                           "negative values."));
}

void NoteChoice(const std::vector<ExrPicture>& pictures,
                const ExrPicture& chosen, const PhotoOptions& options,
                Photo* photo) {
  for (const ExrPicture& p : pictures) {
    photo->layers.push_back(Printable(p.name));
  }
  photo->layer = Printable(chosen.name);
  if (pictures.size() == 1 || !options.layer.empty()) return;
  photo->notes.push_back(
      "Of " + std::to_string(pictures.size()) + " layers " +
      (chosen.name.empty() ? "the one without a name" : photo->layer) +
      (chosen.view.empty() ? "" : " (view " + Printable(chosen.view) + ")") +
      " was read; `layer` names another.");
}

std::string ListChannels(const std::vector<Imf::Header>& headers) {
  std::string found;
  for (const Imf::Header& header : headers) {
    const Imf::ChannelList& channels = header.channels();
    for (auto it = channels.begin(); it != channels.end(); ++it) {
      if (found.size() > 500) return found + " ...";
      found += (found.empty() ? "" : " ") + std::string(it.name());
    }
  }
  return found.empty() ? "none" : found;
}

StatusOr<ExrPicture> FindPicture(const std::string& path,
                                 const std::vector<Imf::Header>& headers,
                                 const PhotoOptions& options, Photo* photo) {
  const std::vector<ExrPicture> pictures =
      ListExrPictures(headers, options.content);
  if (pictures.empty()) {
    const char* const names =
        options.content == PhotoContent::kNormals ? "X Y Z, or R G B"
        : options.content == PhotoContent::kDepth ? "Z, or Y"
                                                  : "R G B, or Y";
    return InvalidInput(
        path + ": channels",
        std::string("expected ") + names +
            ", or a layer that has them; found: " + ListChannels(headers));
  }
  StatusOr<ExrPicture> picture = ChooseExrPicture(path, pictures, options);
  if (picture.ok()) NoteChoice(pictures, *picture, options, photo);
  return picture;
}

StatusOr<Photo> DecodeOrThrow(const std::string& path, const std::string& bytes,
                              const PhotoOptions& options) {
  const StatusOr<std::vector<Imf::Header>> headers =
      ReadHeaders(path, bytes, options.limits);
  if (!headers.ok()) return headers.status();
  Photo photo;
  photo.format = PhotoFormat::kExr;
  const StatusOr<ExrPicture> found =
      FindPicture(path, *headers, options, &photo);
  if (!found.ok()) return found.status();
  ExrPicture picture = *found;

  ExrMemoryInput stream(path, bytes);
  Imf::MultiPartInputFile file(stream, Imf::globalThreadCount(),
                               /*reconstructChunkOffsetTable=*/false);
  if (picture.part >= file.parts()) {
    return InvalidInput(path, "expected as many parts as headers");
  }
  const Imf::Header& header = file.header(picture.part);
  IBRDF_RETURN_IF_ERROR(CheckExrHeader(path, header, options.limits));
  IBRDF_RETURN_IF_ERROR(CheckWindow(path + ": displayWindow",
                                    header.displayWindow(), options.limits));
  if (!file.partComplete(picture.part)) {
    return InvalidInput(path, "incomplete file, expected all its pixels");
  }
  IBRDF_RETURN_IF_ERROR(CheckSampling(path, picture, header));
  const float aspect = header.pixelAspectRatio();
  photo.pixel_aspect = std::isfinite(aspect) && aspect > 0.0f ? aspect : 1.0;
  photo.grey = picture.kind == ExrChannels::kGrey;
  ReadMapAttributes(header, &photo);
  if (!picture.alpha.empty()) {
    const Imf::Channel& alpha = header.channels()[picture.alpha.c_str()];
    if (alpha.xSampling != 1 || alpha.ySampling != 1) picture.alpha.clear();
  }

  const StatusOr<ColourSpace> colours =
      FileColours(path, header, picture, options.content);
  if (!colours.ok()) return colours.status();
  WindowPixels pixels = ReadWindow(&file, picture, header, colours->luminance);
  IBRDF_RETURN_IF_ERROR(
      PlaceInDisplay(path, header, std::move(pixels), &photo));
  if (colours->to_rec709) ConvertColours(*colours->to_rec709, &photo);
  photo.curve = {CurveKind::kLinear, 1.0, "OpenEXR"};
  return photo;
}

}  // namespace

StatusOr<Photo> DecodeExrPhoto(const std::string& path,
                               const std::string& bytes,
                               const PhotoOptions& options) {
  try {
    return DecodeOrThrow(path, bytes, options);
  } catch (const std::exception& e) {
    return InvalidInput(
        path, std::string("expected an OpenEXR image (") + e.what() + ")");
  }
}

}  // namespace ibrdf
