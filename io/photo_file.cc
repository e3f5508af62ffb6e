#include "ibrdf/io/photo_file.h"

#include <exception>
#include <optional>
#include <string_view>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/npy.h"
#include "ibrdf/io/pfm.h"
#include "ibrdf/io/photo_exr.h"
#include "ibrdf/io/photo_jpeg.h"
#include "ibrdf/io/photo_png.h"
#include "ibrdf/io/photo_tiff.h"
#include "ibrdf/io/radiance_hdr.h"

namespace ibrdf {
namespace {

bool StartsWith(std::string_view bytes, std::string_view magic, size_t at = 0) {
  return bytes.size() >= at && bytes.substr(at, magic.size()) == magic;
}

std::optional<PhotoFormat> FindFormat(std::string_view bytes) {
  if (StartsWith(bytes, "\x89PNG\r\n\x1a\n")) return PhotoFormat::kPng;
  if (StartsWith(bytes, "\xff\xd8\xff")) return PhotoFormat::kJpeg;
  for (const std::string_view magic :
       {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
        std::string_view("II+\0", 4), std::string_view("MM\0+", 4)}) {
    if (StartsWith(bytes, magic)) return PhotoFormat::kTiff;
  }
  if (StartsWith(bytes, "\x76\x2f\x31\x01")) return PhotoFormat::kExr;
  if (StartsWith(bytes, "#?")) return PhotoFormat::kRadianceHdr;
  if (StartsWith(bytes, "PF") || StartsWith(bytes, "Pf")) {
    return PhotoFormat::kPfm;
  }
  if (StartsWith(bytes, "\x93NUMPY")) return PhotoFormat::kNpy;
  return std::nullopt;
}

// The name of a format that is known and not read; empty of others.
std::string_view OtherFormat(std::string_view bytes) {
  struct Magic {
    std::string_view bytes;
    size_t at;
    std::string_view name;
  };
  static constexpr Magic kMagics[] = {
      {"ftypheic", 4, "HEIC"},
      {"ftypheix", 4, "HEIC"},
      {"ftypmif1", 4, "HEIF"},
      {"ftypavif", 4, "AVIF"},
      {"ftypcrx ", 4, "Canon raw (CR3)"},
      {"WEBP", 8, "WebP"},
      {"GIF8", 0, "GIF"},
      {"BM", 0, "BMP"},
      {"8BPS", 0, "Photoshop (PSD)"},
      {"FUJIFILMCCD-RAW", 0, "Fujifilm raw"},
      {"IIRO", 0, "Olympus raw"},
      {{"IIU\0", 4}, 0, "Panasonic raw"},
      {{"\0\0\0\x0cJXL ", 8}, 0, "JPEG XL"},
      {"\xff\x0a", 0, "JPEG XL"},
      {{"\0\0\0\x0cjP  ", 8}, 0, "JPEG 2000"},
      {"%PDF", 0, "PDF"},
  };
  for (const Magic& magic : kMagics) {
    if (StartsWith(bytes, magic.bytes, magic.at)) return magic.name;
  }
  return {};
}

StatusOr<Photo> DecodeHdr(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits) {
  StatusOr<Image> image = DecodeRadianceHdr(path, bytes, limits);
  if (!image.ok()) return image.status();
  Photo photo;
  photo.format = PhotoFormat::kRadianceHdr;
  photo.image = *std::move(image);
  photo.curve = {CurveKind::kLinear, 1.0, "Radiance HDR"};
  return photo;
}

StatusOr<Photo> DecodeFormat(PhotoFormat format, const std::string& path,
                             const std::string& bytes,
                             const PhotoOptions& options) {
  switch (format) {
    case PhotoFormat::kPng:
      return DecodePngPhoto(path, bytes, options);
    case PhotoFormat::kJpeg:
      return DecodeJpegPhoto(path, bytes, options);
    case PhotoFormat::kTiff:
      return DecodeTiffPhoto(path, bytes, options);
    case PhotoFormat::kExr:
      return DecodeExrPhoto(path, bytes, options);
    case PhotoFormat::kRadianceHdr:
      return DecodeHdr(path, bytes, options.limits);
    case PhotoFormat::kPfm:
      return DecodePfm(path, bytes, options.limits);
    case PhotoFormat::kNpy:
      return DecodeNpy(path, bytes, options.limits);
  }
  return Status(StatusCode::kInternal, path + ": format");
}

// What holds of every format: the curve, upright pixels.
void Finish(Photo* photo) {
  const ColourTags& tags = photo->tags;
  if (photo->curve.kind == CurveKind::kUnknown) {
    photo->curve = StateCurve(tags, photo->bits == 0);
  }
  // H.273: 1 are the primaries of BT.709, 2 are unspecified.
  const bool cicp_other = tags.cicp && (*tags.cicp)[0] > 2;
  photo->other_primaries =
      photo->format != PhotoFormat::kExr &&
      (cicp_other || (tags.icc && tags.icc->other_primaries) ||
       tags.png_other_primaries || tags.exif_adobe_rgb ||
       tags.exif_colour_space == 2);
  if (photo->orientation == 1) return;
  photo->image = Upright(photo->image, photo->orientation);
  if (!photo->opaque.empty()) {
    photo->opaque = Upright(photo->opaque, photo->orientation);
  }
  if (photo->orientation >= 5) photo->pixel_aspect = 1.0 / photo->pixel_aspect;
  photo->notes.push_back("The picture was turned by EXIF orientation " +
                         std::to_string(photo->orientation) + ".");
}

Status CheckNormals(const std::string& path, const Photo& photo) {
  if (photo.grey) {
    return InvalidInput(path + ": channels",
                        "expected three for normals, found one");
  }
  if (photo.orientation != 1) {
    return InvalidInput(path + ": orientation",
                        "expected normals stored upright (EXIF 1), found " +
                            std::to_string(photo.orientation));
  }
  return OkStatus();
}

StatusOr<Photo> DecodeByContent(const std::string& path,
                                const std::string& bytes,
                                const PhotoOptions& options) {
  const std::optional<PhotoFormat> format = FindFormat(bytes);
  if (!format) {
    const std::string_view other = OtherFormat(bytes);
    return InvalidInput(
        path,
        "expected PNG, JPEG, TIFF, OpenEXR, Radiance HDR, PFM or .npy, "
        "found " +
            (other.empty()
                 ? std::string(bytes.empty() ? "an empty file"
                                             : "none of these")
                 : std::string(other) + "; convert it to PNG or TIFF"));
  }
  if (!options.layer.empty() && *format != PhotoFormat::kExr) {
    return InvalidInput(path + ": layer", std::string("expected OpenEXR, ") +
                                              NameOf(*format) +
                                              " files have no layers");
  }
  StatusOr<Photo> photo = DecodeFormat(*format, path, bytes, options);
  if (!photo.ok()) return photo;
  if (options.content == PhotoContent::kNormals) {
    IBRDF_RETURN_IF_ERROR(CheckNormals(path, *photo));
  }
  Finish(&*photo);
  return photo;
}

}  // namespace

StatusOr<Photo> ReadPhoto(const std::string& path,
                          const PhotoOptions& options) {
  const StatusOr<std::string> bytes = ReadFile(path, kMaxImageFileBytes);
  if (!bytes.ok()) return bytes.status();
  return DecodePhoto(path, *bytes, options);
}

StatusOr<Photo> DecodePhoto(const std::string& path, const std::string& bytes,
                            const PhotoOptions& options) {
  try {
    return DecodeByContent(path, bytes, options);
  } catch (const std::exception&) {  // of memory alone; OpenEXR's are caught
    return InvalidInput(path, "expected an image that fits into memory");
  }
}

}  // namespace ibrdf
