#include "ibrdf/io/photo.h"

#include <cmath>
#include <cstdio>
#include <utility>

namespace ibrdf {
namespace {

constexpr float kOpaque = 0.99f;
// Adobe RGB (1998), 4.3.1.2: 2 + 51 / 256.
constexpr double kAdobeRgbExponent = 2.19921875;
// A power this close to 1 is a straight line.
constexpr double kUnitExponent = 1e-3;

CurveStatement Power(double exponent, std::string source) {
  if (std::fabs(exponent - 1.0) < kUnitExponent) {
    return {CurveKind::kLinear, 1.0, std::move(source)};
  }
  return {CurveKind::kPower, exponent, std::move(source)};
}

// ITU-T H.273, Table 3.
CurveStatement CicpCurve(const std::array<int, 4>& cicp) {
  const std::string source = "cICP transfer " + std::to_string(cicp[1]);
  if (cicp[3] != 1) {
    return {CurveKind::kOther, 1.0, source + " of narrow range"};
  }
  switch (cicp[1]) {
    case 4:
      return {CurveKind::kPower, 2.2, source};
    case 5:
      return {CurveKind::kPower, 2.8, source};
    case 8:
      return {CurveKind::kLinear, 1.0, source};
    case 13:
      return {CurveKind::kSrgb, 1.0, source};
    case 1:
    case 6:
    case 14:
    case 15:
      return {CurveKind::kOther, 1.0, source + " (BT.709)"};
    case 16:
      return {CurveKind::kOther, 1.0, source + " (PQ)"};
    case 18:
      return {CurveKind::kOther, 1.0, source + " (HLG)"};
    default:
      return {CurveKind::kUnknown, 1.0, source};
  }
}

CurveStatement ExifCurve(const ColourTags& tags) {
  const std::string source =
      "EXIF ColorSpace " + std::to_string(tags.exif_colour_space.value_or(0));
  if (tags.exif_adobe_rgb || tags.exif_colour_space == 2) {
    return {CurveKind::kPower, kAdobeRgbExponent, source + " (Adobe RGB)"};
  }
  if (tags.exif_colour_space == 1) return {CurveKind::kSrgb, 1.0, source};
  if (!tags.exif_colour_space) return {};
  return {CurveKind::kUnknown, 1.0, source};
}

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.5g", value);
  return text;
}

// Column and row of the stored pixel that is upright at (x, y); the stored
// picture is width x height. EXIF 2.32, tag 274.
std::pair<int, int> StoredPixel(int orientation, int width, int height, int x,
                                int y) {
  switch (orientation) {
    case 2:
      return {width - 1 - x, y};
    case 3:
      return {width - 1 - x, height - 1 - y};
    case 4:
      return {x, height - 1 - y};
    case 5:
      return {y, x};
    case 6:
      return {y, height - 1 - x};
    case 7:
      return {width - 1 - y, height - 1 - x};
    case 8:
      return {width - 1 - y, x};
    default:
      return {x, y};
  }
}

// Calls copy(stored index, upright index) for each pixel.
template <typename Copy>
void Turn(int orientation, int width, int height, const Copy& copy) {
  const bool sideways = orientation >= 5;
  const int upright_width = sideways ? height : width;
  const int upright_height = sideways ? width : height;
  size_t upright = 0;
  for (int y = 0; y < upright_height; ++y) {
    for (int x = 0; x < upright_width; ++x) {
      const auto [column, row] = StoredPixel(orientation, width, height, x, y);
      copy(static_cast<size_t>(row) * width + column, upright++);
    }
  }
}

}  // namespace

const char* NameOf(PhotoFormat format) {
  switch (format) {
    case PhotoFormat::kPng:
      return "PNG";
    case PhotoFormat::kJpeg:
      return "JPEG";
    case PhotoFormat::kTiff:
      return "TIFF";
    case PhotoFormat::kExr:
      return "OpenEXR";
    case PhotoFormat::kRadianceHdr:
      return "Radiance HDR";
    case PhotoFormat::kPfm:
      return "PFM";
    case PhotoFormat::kNpy:
      return "NumPy";
  }
  return "";
}

CurveStatement StateCurve(const ColourTags& tags, bool floats) {
  CurveStatement unknown;
  const auto known = [&unknown](const CurveStatement& statement) {
    if (statement.kind != CurveKind::kUnknown) return true;
    if (!unknown.source.empty() && !statement.source.empty()) {
      unknown.source += ", ";
    }
    unknown.source += statement.source;
    return false;
  };
  // The PNG specification, third edition, 4.3 gives this order.
  if (tags.cicp) {
    const CurveStatement curve = CicpCurve(*tags.cicp);
    if (known(curve)) return curve;
  }
  if (tags.icc) {
    const CurveStatement curve = {
        tags.icc->curve, tags.icc->exponent,
        "ICC profile '" + tags.icc->description + "'"};
    if (known(curve)) return curve;
  }
  if (tags.png_srgb) return {CurveKind::kSrgb, 1.0, "the sRGB chunk"};
  if (tags.png_gamma) {
    return Power(1.0 / *tags.png_gamma, "gAMA " + Number(*tags.png_gamma));
  }
  const CurveStatement exif = ExifCurve(tags);
  if (known(exif)) return exif;
  if (floats) return {CurveKind::kLinear, 1.0, "floating-point values"};
  return unknown;
}

Image Upright(const Image& stored, int orientation) {
  const bool sideways = orientation >= 5;
  Image upright(sideways ? stored.height : stored.width,
                sideways ? stored.width : stored.height);
  Turn(orientation, stored.width, stored.height, [&](size_t from, size_t to) {
    for (size_t c = 0; c < 3; ++c) {
      upright.rgb[3 * to + c] = stored.rgb[3 * from + c];
    }
  });
  return upright;
}

Mask Upright(const Mask& stored, int orientation) {
  const bool sideways = orientation >= 5;
  Mask upright(sideways ? stored.height : stored.width,
               sideways ? stored.width : stored.height, 0);
  Turn(orientation, stored.width, stored.height, [&](size_t from, size_t to) {
    upright.inside[to] = stored.inside[from];
  });
  return upright;
}

void SetAlpha(const std::vector<float>& alpha, Photo* photo) {
  Mask mask(photo->image.width, photo->image.height, 0);
  size_t opaque = 0, partial = 0;
  for (size_t i = 0; i < alpha.size(); ++i) {
    mask.inside[i] = alpha[i] >= kOpaque ? 1 : 0;
    opaque += mask.inside[i];
    partial += alpha[i] > 0.0f && alpha[i] < kOpaque;
  }
  if (opaque == alpha.size()) return;
  if (opaque == 0) {
    photo->notes.push_back(
        "No pixel's alpha is 0.99 or more: alpha is not taken as a mask.");
    return;
  }
  if (partial > 0) {
    photo->notes.push_back(std::to_string(partial) +
                           " pixels are partly transparent and count as "
                           "outside of the mask.");
  }
  photo->opaque = std::move(mask);
}

void AddExif(const ExifTags& exif, Photo* photo) {
  photo->orientation = exif.orientation;
  photo->tags.exif_colour_space = exif.colour_space;
  photo->tags.exif_adobe_rgb = exif.adobe_rgb;
  photo->exposure_seconds = exif.exposure_seconds;
  photo->f_number = exif.f_number;
  photo->iso = exif.iso;
  if (exif.damaged) {
    photo->notes.push_back("Some EXIF tags are damaged and were left out.");
  }
}

Status CheckSquarePixels(const std::string& path, const Photo& photo) {
  if (photo.pixel_aspect == 1.0) return OkStatus();
  return InvalidInput(path + ": pixelAspectRatio",
                      "expected 1, found " +
                          std::to_string(photo.pixel_aspect) +
                          "; resample the picture to square pixels");
}

std::string Printable(const std::string& text) {
  std::string out = text;
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return out;
}

}  // namespace ibrdf
