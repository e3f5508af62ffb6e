#include "ibrdf/solvers/bench/photograph_settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/photo_writer.h"

namespace ibrdf {
namespace {

using Settings = std::vector<PhotographSetting>;

PhotographSetting Srgb(const std::string& name) {
  PhotographSetting setting;
  setting.name = name;
  setting.curve.kind = ResponseKind::kSrgb;
  return setting;
}

// Nothing is clipped; the files differ.
void AddFiles(Settings* settings) {
  PhotographSetting& hdr = settings->emplace_back(Srgb("hdr"));
  hdr.file = PhotographFile::kExr;
  hdr.curve.kind = ResponseKind::kLinear;
  for (const int bits : {8, 6, 10, 12, 16}) {
    PhotographSetting& png =
        settings->emplace_back(Srgb("srgb_" + std::to_string(bits) + "_bits"));
    png.bits = bits;
    png.response = "srgb";
  }
  for (const int quality : {95, 90, 75, 50}) {
    PhotographSetting& jpeg =
        settings->emplace_back(Srgb("jpeg_" + std::to_string(quality)));
    jpeg.file = PhotographFile::kJpeg;
    jpeg.quality = quality;
  }
}

// 8 bits, and what others make of clipped values.
void AddClipped(Settings* settings) {
  for (const int share : {1, 2, 5, 10, 20}) {
    const std::string name = "clipped_" + std::to_string(share);
    PhotographSetting& png = settings->emplace_back(Srgb(name));
    png.clipped = 0.01 * share;
    const PhotographSetting base = png;
    for (const ClippedValues values :
         {ClippedValues::kData, ClippedValues::kMissing}) {
      PhotographSetting& exr = settings->emplace_back(base);
      const bool data = values == ClippedValues::kData;
      exr.name = name + (data ? "_as_data" : "_as_missing");
      exr.file = PhotographFile::kExr;
      exr.values = values;
    }
  }
}

// Curves that the solver is told, is not told, or is told wrongly.
void AddCurves(Settings* settings) {
  struct Curve {
    const char* name;
    ResponseKind kind;
    double parameter;
  };
  for (const Curve& curve : {Curve{"aces_0.2", ResponseKind::kAces, 0.2},
                             Curve{"aces_0.5", ResponseKind::kAces, 0.5},
                             Curve{"aces_1", ResponseKind::kAces, 1.0},
                             Curve{"power_1.8", ResponseKind::kPower, 1.8},
                             Curve{"power_2.6", ResponseKind::kPower, 2.6}}) {
    PhotographSetting made = Srgb(curve.name);
    made.curve.kind = curve.kind;
    made.curve.parameter = curve.parameter;
    PhotographSetting& told = settings->emplace_back(made);
    told.response = NameOf(curve.kind) +
                    ", response_parameter: " + std::to_string(curve.parameter);
    PhotographSetting& unknown = settings->emplace_back(made);
    unknown.name += "_unknown";
    unknown.response = "unknown_" + NameOf(curve.kind);
    PhotographSetting& any = settings->emplace_back(made);
    any.name += "_any";
    any.response = "unknown";
    PhotographSetting& wrong = settings->emplace_back(made);
    wrong.name += "_as_srgb";
  }
}

// The value that a share of the object's values is above.
double ValueAt(double share, const Image& radiance, const Mask& mask) {
  std::vector<float> values;
  for (size_t k = 0; k < radiance.rgb.size(); ++k) {
    if (mask.Holds(k / 3) && std::isfinite(radiance.rgb[k])) {
      values.push_back(radiance.rgb[k]);
    }
  }
  if (values.empty()) return 1.0;
  const auto above =
      std::min(static_cast<size_t>(share * static_cast<double>(values.size())),
               values.size() - 1);
  std::nth_element(values.begin(), values.begin() + above, values.end(),
                   std::greater<float>());
  return std::max(values[above], std::numeric_limits<float>::min());
}

}  // namespace

const Settings& PhotographSettings() {
  static const Settings settings = [] {
    Settings all;
    AddFiles(&all);
    AddClipped(&all);
    AddCurves(&all);
    return all;
  }();
  return settings;
}

std::string ExtensionOf(const PhotographSetting& setting) {
  switch (setting.file) {
    case PhotographFile::kExr:
      return ".exr";
    case PhotographFile::kPng:
      return ".png";
    case PhotographFile::kJpeg:
      break;
  }
  return ".jpg";
}

Status WritePhotograph(const PhotographSetting& setting, const Image& radiance,
                       const Mask& mask, const std::string& path) {
  if (setting.file == PhotographFile::kExr && setting.clipped == 0.0) {
    return WriteExr(radiance, path);
  }
  const ResponseCurve curve(setting.curve);
  const double exposure =
      curve.Decode(1.0) / ValueAt(setting.clipped, radiance, mask);
  const int white = (1 << setting.bits) - 1;
  CodeImage codes{radiance.width, radiance.height, setting.bits, {}};
  for (const float v : radiance.rgb) {
    const double y = curve.Encode(exposure * std::max(v, 0.0f));
    codes.rgb.push_back(static_cast<uint16_t>(
        std::lround(white * std::min(std::isfinite(y) ? y : 0.0, 1.0))));
  }
  if (setting.file == PhotographFile::kExr) {
    Image decoded(radiance.width, radiance.height);
    for (size_t k = 0; k < codes.rgb.size(); ++k) {
      const bool clipped = codes.rgb[k] == white;
      decoded.rgb[k] = clipped && setting.values == ClippedValues::kMissing
                           ? std::numeric_limits<float>::quiet_NaN()
                           : static_cast<float>(curve.Decode(
                                 static_cast<double>(codes.rgb[k]) / white));
    }
    return WriteExr(decoded, path);
  }
  return WriteFileAtomically(path,
                             setting.file == PhotographFile::kPng
                                 ? EncodeCodesAsPng(codes)
                                 : EncodeCodesAsJpeg(codes, setting.quality));
}

}  // namespace ibrdf
