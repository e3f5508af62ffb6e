#include "tests/fuzz/image_parsers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/io/exif.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/icc_profile.h"
#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/photo_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/radiance_hdr.h"
#include "ibrdf/light/convert_map.h"
#include "ibrdf/solvers/problem/load_depth.h"
#include "ibrdf/solvers/problem/load_normals.h"
#include "tests/support/png_crc.h"

namespace ibrdf {
namespace {

// What a small file claims beyond this is refused, as larger claims are with
// the limits of the programs: time goes into parsing, not into large images.
constexpr ImageLimits kLimits{256, 1 << 14};

void CheckImage(const StatusOr<Image>& image, const std::string& name) {
  if (!image.ok()) return CheckError(image.status(), name);
  CHECK(CheckImageSize(name, image->width, image->height, kLimits).ok());
  CHECK_EQ(image->rgb.size(), 3 * image->num_pixels());
}

void FuzzExr(const std::string& bytes) {
  CheckImage(DecodeExr("a.exr", bytes, kLimits), "a.exr");
}

void FuzzHdr(const std::string& bytes) {
  const StatusOr<Image> image = DecodeRadianceHdr("a.hdr", bytes, kLimits);
  CheckImage(image, "a.hdr");
  if (!image.ok()) return;
  for (const float value : image->rgb) CHECK(!std::isnan(value) && value >= 0);
}

// Gives every chunk the checksum that fits it, as far as chunks go.
void FixPngChecksums(std::string* png) {
  constexpr size_t kSignature = 8, kSizeAndType = 8, kChecksum = 4;
  size_t at = kSignature;
  while (png->size() >= at + kSizeAndType + kChecksum) {
    uint32_t size = 0;
    for (size_t i = 0; i < 4; ++i) {
      size = size << 8 | static_cast<uint8_t>((*png)[at + i]);
    }
    if (size > png->size() - at - kSizeAndType - kChecksum) return;
    const uint32_t crc = PngCrc(png->data() + at + 4, size + 4);
    at += kSizeAndType + size;
    for (size_t i = 0; i < 4; ++i) {
      (*png)[at + i] = static_cast<char>(crc >> (24 - 8 * i));
    }
    at += kChecksum;
  }
}

void FuzzPng(const std::string& input) {
  if (input.empty()) return;
  std::string bytes = input.substr(1);
  if (input[0] & 1) FixPngChecksums(&bytes);
  const StatusOr<Mask> mask = DecodeMask("a.png", bytes, kLimits);
  if (!mask.ok()) return CheckError(mask.status(), "a.png");
  CHECK(CheckImageSize("a.png", mask->width, mask->height, kLimits).ok());
  CHECK_EQ(mask->inside.size(),
           static_cast<size_t>(mask->width) * mask->height);
  for (const uint8_t v : mask->inside) CHECK_LE(v, 1);
}

void CheckMask(const Mask& mask, const Photo& photo) {
  if (mask.empty()) return;
  CHECK_EQ(mask.width, photo.image.width);
  CHECK_EQ(mask.inside.size(), photo.image.num_pixels());
  for (const uint8_t v : mask.inside) CHECK_LE(v, 1);
}

// `magic`: the format is this one, whatever the bytes begin with.
void FuzzPhoto(const std::string& bytes, const std::string& magic,
               PhotoContent content = PhotoContent::kColour) {
  std::string file = bytes;
  file.replace(0, std::min(magic.size(), file.size()), magic);
  PhotoOptions options;
  options.content = content;
  options.limits = kLimits;
  const StatusOr<Photo> photo = DecodePhoto("a.photo", file, options);
  if (!photo.ok()) return CheckError(photo.status(), "a.photo");
  CHECK(CheckImageSize("a.photo", photo->image.width, photo->image.height,
                       kLimits)
            .ok());
  CHECK_EQ(photo->image.rgb.size(), 3 * photo->image.num_pixels());
  CheckMask(photo->opaque, *photo);
  CheckMask(photo->has_data, *photo);
  CHECK(photo->bits >= 0 && photo->bits <= 16);
  CHECK(photo->significant_bits >= 0 && photo->significant_bits <= photo->bits);
  if (photo->bits > 0) {
    const float largest = static_cast<float>((1 << photo->bits) - 1);
    for (const float v : photo->image.rgb) CHECK(v >= 0.0f && v <= largest);
  }
  CHECK(photo->pixel_aspect > 0.0 && std::isfinite(photo->pixel_aspect));
  CHECK(photo->orientation >= 1 && photo->orientation <= 8);
  CheckOneLine(photo->curve.source);
  CheckOneLine(photo->layer);
  for (const std::string& note : photo->notes) CheckOneLine(note);
}

void FuzzPhotoPng(const std::string& input) {
  if (input.empty()) return;
  std::string bytes = input.substr(1);
  if (input[0] & 1) FixPngChecksums(&bytes);
  FuzzPhoto(bytes, "\x89PNG\r\n\x1a\n");
}

void FuzzPhotoExr(const std::string& input) {
  if (input.empty()) return;
  FuzzPhoto(input.substr(1), "\x76\x2f\x31\x01",
            input[0] & 1 ? PhotoContent::kNormals : PhotoContent::kColour);
}

void FuzzExif(const std::string& bytes) {
  const ExifTags exif = ParseExif(bytes);
  CHECK(exif.orientation >= 1 && exif.orientation <= 8);
  for (const auto& value : {exif.exposure_seconds, exif.f_number, exif.iso}) {
    CHECK(!value || (*value > 0.0 && std::isfinite(*value)));
  }
}

void FuzzIcc(const std::string& bytes) {
  const std::optional<IccProfile> profile = ParseIccProfile(bytes);
  if (!profile) return;
  CheckOneLine(profile->description);
  CHECK(profile->exponent > 0.0 && std::isfinite(profile->exponent));
}

// As any frame, by the first byte, or as what the file says.
void FuzzMap(const std::string& input) {
  if (input.empty()) return;
  const size_t word = static_cast<uint8_t>(input[0]) % (kMapFrames.size() + 1);
  std::optional<MapFrame> frame;
  if (word < kMapFrames.size()) frame = kMapFrames[word];
  const StatusOr<StoredMap> map =
      DecodeStoredMap("a.map", input.substr(1), frame, kLimits);
  if (!map.ok()) return CheckError(map.status(), "a.map");
  CHECK(!frame || map->frame == *frame);
  for (const std::string& warning : map->warnings) CheckOneLine(warning);
  for (const float v : map->image.rgb) CHECK(std::isfinite(v) && v >= 0.0f);
  // Between frames, in small: what is tested is not its speed.
  if (map->image.num_pixels() > 256) return;
  const StatusOr<Image> ours =
      ToLibraryFrame("a.map", map->image, map->frame, 1);
  if (!ours.ok()) return CheckError(ours.status(), "a.map");
  for (const float v : ours->rgb) CHECK(std::isfinite(v) && v >= 0.0f);
}

void CheckNormalMap(const StatusOr<NormalMap>& map) {
  if (!map.ok()) return CheckError(map.status(), "a.geometry");
  CHECK(CheckImageSize("a", map->normals.width, map->normals.height, kLimits)
            .ok());
  for (const std::string& warning : map->warnings) CheckOneLine(warning);
}

// The first byte: camera and scale.
void FuzzDepth(const std::string& input) {
  if (input.empty()) return;
  GeometrySpec geometry;
  geometry.file = "a.geometry";
  Camera camera;
  if (input[0] & 1) camera.type = CameraType::kPerspective;
  if (input[0] & 2) geometry.depth_scale = 0.01;
  const StatusOr<NormalMap> map =
      DecodeDepth(geometry, camera, input.substr(1), kLimits);
  CheckNormalMap(map);
  if (!map.ok()) return;
  for (const float v : map->normals.rgb) CHECK(std::isfinite(v));
}

// The first byte: encoding and frame.
void FuzzNormals(const std::string& input) {
  if (input.empty()) return;
  GeometrySpec geometry;
  geometry.file = "a.geometry";
  if (input[0] & 1) geometry.frame = kOpenCvFrame;
  if (input[0] & 2) geometry.encoding = NormalEncoding::kUnit01;
  if (input[0] & 4) geometry.encoding = NormalEncoding::kFloat;
  CheckNormalMap(DecodeNormals(geometry, input.substr(1), kLimits));
}

}  // namespace

std::vector<FuzzedParser> ImageParsers() {
  return {{"exr", FuzzExr},
          {"hdr", FuzzHdr},
          {"png", FuzzPng},
          {"photo_png", FuzzPhotoPng},
          {"photo_jpeg",
           [](const std::string& b) { FuzzPhoto(b, "\xff\xd8\xff"); }},
          // TIFF is of either byte order: the first bytes stay.
          {"photo_tiff", [](const std::string& b) { FuzzPhoto(b, ""); }},
          {"photo_exr", FuzzPhotoExr},
          {"npy", [](const std::string& b) { FuzzPhoto(b, "\x93NUMPY"); }},
          {"pfm", [](const std::string& b) { FuzzPhoto(b, "P"); }},
          {"exif", FuzzExif},
          {"icc", FuzzIcc},
          {"map", FuzzMap},
          {"depth", FuzzDepth},
          {"normals", FuzzNormals}};
}

}  // namespace ibrdf
