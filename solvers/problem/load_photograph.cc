#include "ibrdf/solvers/problem/load_photograph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "ibrdf/image/code_interval.h"
#include "ibrdf/image/response_curve.h"
#include "ibrdf/io/photo_file.h"
#include "ibrdf/io/png.h"

namespace ibrdf {
namespace {

// Values are said to look saturated where more than this share of the object's
// are the greatest one.
constexpr double kSaturatedShare = 0.01;
// Above it the values are alike, as of an even grey, and nothing is cut off.
constexpr double kAlikeShare = 0.9;
// Brackets contradict each other where their log radiance differs by more,
// above noise, and that is said where this share of their values does.
constexpr double kContradiction = 0.1;
constexpr double kContradictedShare = 0.02;
// Values that say whether floats are multiples of 1/255.
constexpr size_t kFewestValues = 100;

std::string Percent(double share) {
  const double percent = 100.0 * share;
  const int rounded = static_cast<int>(std::lround(percent));
  return percent < 1.0 ? "less than 1 %" : std::to_string(rounded) + " %";
}

// What the file says of its curve; the error asks for image.response.
StatusOr<ResponseDefinition> StatedCurve(const std::string& path,
                                         const Photo& photo,
                                         std::vector<std::string>* warnings) {
  ResponseDefinition curve;
  switch (photo.curve.kind) {
    case CurveKind::kLinear:
      return curve;
    case CurveKind::kSrgb:
      curve.kind = ResponseKind::kSrgb;
      return curve;
    case CurveKind::kPower:
      curve.kind = ResponseKind::kPower;
      curve.parameter = photo.curve.exponent;
      IBRDF_RETURN_IF_ERROR(curve.Check(path + ": " + photo.curve.source));
      return curve;
    case CurveKind::kUnknown:
      if (photo.bits > 8) break;
      curve.kind = ResponseKind::kSrgb;
      warnings->push_back(
          path +
          ": no response curve is stated; sRGB is assumed (image.response)");
      return curve;
    case CurveKind::kOther:
      break;
  }
  return InvalidInput(
      path,
      std::string("the response curve of a ") + NameOf(photo.format) +
          " file of " + std::to_string(photo.bits) + " bits is not " +
          (photo.curve.source.empty()
               ? std::string("stated")
               : "understood (" + photo.curve.source + ")") +
          "; say image.response (--response on the command line), as srgb or "
          "linear");
}

StatusOr<ResponseCurve> CurveOf(const ImageSpec& spec, const Photo& photo,
                                std::vector<std::string>* warnings) {
  const std::vector<CurveFamily> families = FamiliesOf(spec.response);
  const std::optional<ResponseKind> kind =
      families.empty() ? KnownResponse(spec.response) : families.front().kind;
  if (!families.empty() && photo.bits == 0) {
    return InvalidInput(spec.file + ": image.response",
                        "unknown is for files of whole numbers, and this one "
                        "holds floats");
  }
  if (!kind.has_value()) {
    if (photo.bits == 0) return ResponseCurve();
    const StatusOr<ResponseDefinition> stated =
        StatedCurve(spec.file, photo, warnings);
    if (!stated.ok()) return stated.status();
    return ResponseCurve(*stated);
  }
  ResponseDefinition curve;
  curve.kind = *kind;
  curve.parameter = spec.response_parameter;
  IBRDF_RETURN_IF_ERROR(curve.Check(spec.file + ": image.response_parameter"));
  return ResponseCurve(curve);
}

// "srgb (gAMA 0.45455)": the curve and who says so.
std::string CurveInWords(const ImageSpec& spec, const Photo& photo,
                         const ResponseCurve& curve) {
  std::string source = "assumed of 8 bits";
  if (spec.response >= ResponseChoice::kUnknown) {
    return "to be found; " + NameOf(curve.kind()) + " until then";
  }
  if (spec.response != ResponseChoice::kAuto) {
    source = "image.response";
  } else if (photo.bits == 0) {
    source = "the file holds floats";
  } else if (!photo.curve.source.empty()) {
    source = photo.curve.source;
  }
  return NameOf(curve.kind()) + " (" + source + ")";
}

StatusOr<CodeLevels> LevelsOf(const ImageSpec& spec, const Photo& photo) {
  CodeLevels levels = CodeLevels::OfBits(photo.bits);
  levels.black = spec.black.value_or(levels.black);
  levels.white = spec.white.value_or(levels.white);
  levels.exposure = spec.exposure;
  if (photo.significant_bits > 0 && photo.significant_bits < photo.bits) {
    levels.step = std::exp2(photo.bits - photo.significant_bits);
  }
  IBRDF_RETURN_IF_ERROR(levels.Check(spec.file + ": image.white"));
  return levels;
}

Status Linearise(const ImageSpec& spec, const ResponseCurve& curve,
                 const Photo& photo, Photograph* photograph) {
  if (photo.bits > 0) {
    const StatusOr<CodeLevels> levels = LevelsOf(spec, photo);
    if (!levels.ok()) return levels.status();
    DecodedCodes decoded = DecodeCodes(curve, *levels, photograph->radiance);
    const std::vector<CurveFamily> families = FamiliesOf(spec.response);
    if (!families.empty()) {
      photograph->unknown_curve =
          UnknownCurve{std::move(photograph->radiance), *levels, families};
    }
    photograph->radiance = std::move(decoded.radiance);
    photograph->bounds = std::move(decoded.bounds);
    return OkStatus();
  }
  if (spec.white.has_value() || spec.black.has_value()) {
    return InvalidInput(spec.file,
                        "image.white and image.black are of files of whole "
                        "numbers, found one of floats");
  }
  if (curve.kind() == ResponseKind::kLinear && spec.exposure == 1.0) {
    return OkStatus();
  }
  for (float& v : photograph->radiance.rgb) {
    const RadianceInterval interval = FloatInterval(curve, spec.exposure, v);
    v = interval.IsMissing() ? std::numeric_limits<float>::quiet_NaN()
                             : static_cast<float>(interval.low);
  }
  return OkStatus();
}

// Narrows what is known of a value's radiance to what another file allows. The
// log by which they contradict each other; 0: they agree.
double Narrow(const DecodedCodes& other, size_t value, Photograph* photograph) {
  RadianceBounds& bounds = *photograph->bounds;
  const BracketedInterval both = IntersectBrackets(
      {{bounds.low.rgb[value], bounds.high.rgb[value]},
       {other.bounds.low.rgb[value], other.bounds.high.rgb[value]}});
  const RadianceInterval& all = both.interval;
  bounds.low.rgb[value] = static_cast<float>(all.low);
  bounds.high.rgb[value] = static_cast<float>(all.high);
  if (!all.IsMissing()) {
    photograph->radiance.rgb[value] =
        static_cast<float>(!all.HasHigh()  ? all.low
                           : !all.HasLow() ? all.high
                                           : std::sqrt(all.low * all.high));
  }
  return both.contradiction;
}

// Adds the further files of the same view.
Status AddBrackets(const ImageSpec& spec, const ResponseCurve& curve,
                   Photograph* photograph) {
  if (spec.brackets.empty()) return OkStatus();
  if (!photograph->bounds || photograph->unknown_curve) {
    return InvalidInput(spec.file + ": image.brackets",
                        "expected whole numbers and a known response; floats "
                        "are radiance already");
  }
  size_t contradicted = 0;
  for (size_t k = 0; k < spec.brackets.size(); ++k) {
    ImageSpec one = spec;
    one.file = spec.brackets[k];
    one.exposure = spec.bracket_exposures[k];
    PhotoOptions options;
    options.layer = spec.layer;
    const StatusOr<Photo> photo = ReadPhoto(one.file, options);
    if (!photo.ok()) return photo.status();
    if (photo->bits == 0) {
      return InvalidInput(one.file, "image.brackets: found floats");
    }
    const Image& codes = photo->image;
    if (codes.width != photograph->radiance.width ||
        codes.height != photograph->radiance.height) {
      return InvalidInput(
          one.file, "image.brackets: expected the size of " + spec.file + ", " +
                        SizeName(photograph->radiance.width,
                                 photograph->radiance.height) +
                        ", found " + SizeName(codes.width, codes.height));
    }
    const StatusOr<CodeLevels> levels = LevelsOf(one, *photo);
    if (!levels.ok()) return levels.status();
    const DecodedCodes decoded = DecodeCodes(curve, *levels, codes);
    for (size_t i = 0; i < codes.rgb.size(); ++i) {
      contradicted += Narrow(decoded, i, photograph) > kContradiction;
    }
  }
  const double share = static_cast<double>(contradicted) /
                       static_cast<double>(photograph->radiance.rgb.size());
  if (share > kContradictedShare) {
    photograph->warnings.push_back(
        spec.file + ": the brackets contradict each other at " +
        Percent(share) +
        " of the values: did something move, or are the exposures or the "
        "response others (image.bracket_exposures)?");
  }
  return OkStatus();
}

StatusOr<Mask> LoadMask(const std::string& path, const Image& image) {
  StatusOr<Mask> mask = ReadMask(path);
  if (!mask.ok()) return mask.status();
  if (mask->width == image.width && mask->height == image.height) return mask;
  return InvalidInput(
      path, "expected the image's size " + SizeName(image.width, image.height) +
                ", found " + SizeName(mask->width, mask->height));
}

// Takes pixels out of the mask that are not in `kept`; either may be empty.
void Restrict(const Mask& kept, Mask* mask) {
  if (kept.inside.empty()) return;
  if (mask->inside.empty()) {
    *mask = kept;
    return;
  }
  for (size_t i = 0; i < kept.inside.size(); ++i) {
    mask->inside[i] = mask->inside[i] && kept.inside[i] ? 1 : 0;
  }
}

bool IsInside(const Mask& mask, size_t pixel) {
  return mask.inside.empty() || mask.inside[pixel] != 0;
}

void WarnOfClipped(const std::string& path, const Photograph& photograph,
                   std::vector<std::string>* warnings) {
  size_t clipped = 0, values = 0;
  const std::vector<float>& high = photograph.bounds->high.rgb;
  for (size_t k = 0; k < high.size(); ++k) {
    if (!IsInside(photograph.mask, k / 3)) continue;
    ++values;
    clipped += std::isinf(high[k]);
  }
  if (clipped == 0) return;
  warnings->push_back(
      path + ": " +
      Percent(static_cast<double>(clipped) / static_cast<double>(values)) +
      " of the object's values are clipped (image.white): of their radiance "
      "the least is known");
}

}  // namespace

Image KnownRadiance(const Photograph& observed) {
  Image known = observed.radiance;
  if (!observed.bounds) return known;
  for (size_t k = 0; k < known.rgb.size(); ++k) {
    if (std::isinf(observed.bounds->high.rgb[k])) {
      known.rgb[k] = std::numeric_limits<float>::quiet_NaN();
    } else if (observed.bounds->low.rgb[k] == 0.0f) {
      known.rgb[k] = 0.0f;
    }
  }
  return known;
}

std::vector<std::string> DoubtfulValues(const Image& radiance,
                                        const Mask& mask) {
  std::vector<float> values;
  for (size_t k = 0; k < radiance.rgb.size(); ++k) {
    const float v = radiance.rgb[k];
    if (IsInside(mask, k / 3) && std::isfinite(v) && v > 0.0f) {
      values.push_back(v);
    }
  }
  std::vector<std::string> warnings;
  if (values.size() < kFewestValues) return warnings;
  const float most = *std::max_element(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  const double share =
      static_cast<double>(std::count(values.begin(), values.end(), most)) /
      count;
  if (share > kSaturatedShare && share < kAlikeShare) {
    warnings.push_back(Percent(share) +
                       " of the object's values are the same greatest one: "
                       "saturated? Clipped highlights look less glossy than "
                       "they are");
  }
  const bool codes = std::all_of(values.begin(), values.end(), [](float v) {
    const double code = 255.0 * static_cast<double>(v);
    return code < 255.5 && std::abs(code - std::round(code)) < 1e-3;
  });
  if (codes && share < kAlikeShare) {
    warnings.push_back(
        "all values are multiples of 1/255: are they codes of an 8-bit picture "
        "and no linear radiance? Then say image.response: srgb");
  }
  return warnings;
}

StatusOr<Photograph> LoadPhotograph(const ImageSpec& spec) {
  PhotoOptions options;
  options.layer = spec.layer;
  StatusOr<Photo> photo = ReadPhoto(spec.file, options);
  if (!photo.ok()) return photo.status();
  IBRDF_RETURN_IF_ERROR(CheckSquarePixels(spec.file, *photo));
  Photograph photograph;
  for (const std::string& note : photo->notes) {
    photograph.warnings.push_back(spec.file + ": " + note);
  }
  if (photo->other_primaries) {
    photograph.warnings.push_back(
        spec.file +
        ": its primaries are not those of Rec. 709 and were not converted");
  }
  const StatusOr<ResponseCurve> curve =
      CurveOf(spec, *photo, &photograph.warnings);
  if (!curve.ok()) return curve.status();
  photograph.codes = photo->bits > 0;
  photograph.curve = CurveInWords(spec, *photo, *curve);
  photograph.radiance = std::move(photo->image);
  IBRDF_RETURN_IF_ERROR(Linearise(spec, *curve, *photo, &photograph));
  IBRDF_RETURN_IF_ERROR(AddBrackets(spec, *curve, &photograph));
  if (!spec.mask.empty()) {
    StatusOr<Mask> mask = LoadMask(spec.mask, photograph.radiance);
    if (!mask.ok()) return mask.status();
    photograph.mask = *std::move(mask);
  }
  const size_t of_mask_file = photograph.mask.CountInside();
  Restrict(photo->has_data, &photograph.mask);
  Restrict(photo->opaque, &photograph.mask);
  if (!spec.mask.empty()) {
    photograph.missing = of_mask_file - photograph.mask.CountInside();
  }
  if (photo->bits > 0) {
    WarnOfClipped(spec.file, photograph, &photograph.warnings);
  } else if (curve->kind() == ResponseKind::kLinear) {
    for (const std::string& doubt :
         DoubtfulValues(photograph.radiance, photograph.mask)) {
      photograph.warnings.push_back(spec.file + ": " + doubt);
    }
  }
  return photograph;
}

}  // namespace ibrdf
