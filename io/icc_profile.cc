#include "ibrdf/io/icc_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace ibrdf {
namespace {

constexpr size_t kIccHeaderBytes = 128;
constexpr size_t kTagBytes = 12;
constexpr size_t kMaxTags = 1000;
constexpr size_t kMaxDescription = 200;
// Largest distance of curves that count as the same, in linear light. Half of
// it is what tables of 8 bits lose; power 2.2 is 6e-3 from sRGB.
constexpr double kCurveTolerance = 1e-3;

std::optional<uint32_t> BigEndian(std::string_view bytes, size_t at,
                                  size_t count) {
  if (at > bytes.size() || count > bytes.size() - at) return std::nullopt;
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) {
    value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  }
  return value;
}

// s15Fixed16Number.
std::optional<double> Fixed(std::string_view bytes, size_t at) {
  const std::optional<uint32_t> value = BigEndian(bytes, at, 4);
  if (!value) return std::nullopt;
  return static_cast<int32_t>(*value) / 65536.0;
}

// The data of a tag; empty where it is absent or does not fit.
std::string_view FindTag(std::string_view bytes, std::string_view signature) {
  const size_t count = BigEndian(bytes, kIccHeaderBytes, 4).value_or(0);
  for (size_t i = 0; i < count && i < kMaxTags; ++i) {
    const size_t at = kIccHeaderBytes + 4 + kTagBytes * i;
    const std::optional<uint32_t> offset = BigEndian(bytes, at + 4, 4);
    const std::optional<uint32_t> size = BigEndian(bytes, at + 8, 4);
    if (!offset || !size) return {};
    if (bytes.substr(at, 4) != signature) continue;
    if (*offset > bytes.size() || *size > bytes.size() - *offset) return {};
    return bytes.substr(*offset, *size);
  }
  return {};
}

void AppendUtf8(uint32_t unit, std::string* text) {
  if (unit < 0x80) {
    text->push_back(static_cast<char>(unit));
  } else if (unit < 0x800) {
    text->push_back(static_cast<char>(0xC0 | unit >> 6));
    text->push_back(static_cast<char>(0x80 | (unit & 0x3F)));
  } else if (unit >= 0xD800 && unit < 0xE000) {
    text->push_back('?');  // half of a surrogate pair
  } else {
    text->push_back(static_cast<char>(0xE0 | unit >> 12));
    text->push_back(static_cast<char>(0x80 | (unit >> 6 & 0x3F)));
    text->push_back(static_cast<char>(0x80 | (unit & 0x3F)));
  }
}

// textDescriptionType (version 2) or multiLocalizedUnicodeType (version 4, its
// first record).
std::string Description(std::string_view tag) {
  std::string text;
  if (tag.substr(0, 4) == "desc") {
    const size_t count = BigEndian(tag, 8, 4).value_or(0);
    if (tag.size() > 12) {
      for (const char c : tag.substr(12, std::min(count, kMaxDescription))) {
        if (c == '\0') break;
        // ASCII by the standard; other bytes might break the text's encoding.
        text.push_back(static_cast<unsigned char>(c) < 0x80 ? c : '?');
      }
    }
  } else if (tag.substr(0, 4) == "mluc") {
    const size_t length = BigEndian(tag, 20, 4).value_or(0);
    const size_t offset = BigEndian(tag, 24, 4).value_or(0);
    for (size_t i = 0; i + 1 < length && i < 2 * kMaxDescription; i += 2) {
      const std::optional<uint32_t> unit = BigEndian(tag, offset + i, 2);
      if (!unit || *unit == 0) break;
      AppendUtf8(*unit, &text);
    }
  }
  return Printable(text);
}

// IEC 61966-2-1: code value to linear light.
double SrgbToLinear(double y) {
  return y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
}

struct Curve {
  CurveKind kind = CurveKind::kOther;
  double exponent = 1.0;
};

Curve PowerCurve(double exponent) {
  if (std::fabs(exponent - 1.0) < kCurveTolerance) {
    return {CurveKind::kLinear, 1.0};
  }
  if (!(exponent > 0.0)) return {};
  return {CurveKind::kPower, exponent};
}

// Names the curve whose linear light at y = i / (count - 1) is linear(i).
template <typename Linear>
Curve NameSampled(size_t count, const Linear& linear) {
  double to_srgb = 0.0, to_line = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const double y = static_cast<double>(i) / static_cast<double>(count - 1);
    const double value = linear(i);
    if (!std::isfinite(value)) return {};
    to_srgb = std::max(to_srgb, std::fabs(value - SrgbToLinear(y)));
    to_line = std::max(to_line, std::fabs(value - y));
  }
  if (to_srgb < kCurveTolerance) return {CurveKind::kSrgb, 1.0};
  if (to_line < kCurveTolerance) return {CurveKind::kLinear, 1.0};
  return {};
}

// curveType: a line, a power of u8Fixed8, or a table of 16 bits.
Curve TableCurve(std::string_view tag) {
  const std::optional<uint32_t> count = BigEndian(tag, 8, 4);
  if (!count) return {};
  if (*count == 0) return {CurveKind::kLinear, 1.0};
  if (tag.size() < 12 || *count > (tag.size() - 12) / 2) return {};
  if (*count == 1) return PowerCurve(*BigEndian(tag, 12, 2) / 256.0);
  return NameSampled(*count, [&](size_t i) {
    return *BigEndian(tag, 12 + 2 * i, 2) / 65535.0;
  });
}

using Parameters = std::array<double, 7>;  // g a b c d e f

// Linear light of code value y, ICC.1:2010 Table 65; `type` 1 to 4.
double ParametricValue(uint32_t type, const Parameters& parameters, double y) {
  const auto [g, a, b, c, d, e, f] = parameters;
  const double power = std::pow(std::max(a * y + b, 0.0), g);
  if (type == 1) return a * y >= -b ? power : 0.0;
  if (type == 2) return a * y >= -b ? power + c : c;
  if (type == 3) return y >= d ? power : c * y;
  return y >= d ? power + e : c * y + f;
}

// parametricCurveType.
Curve ParametricCurve(std::string_view tag) {
  constexpr std::array<size_t, 5> kCounts = {1, 3, 4, 5, 7};
  const uint32_t type =
      BigEndian(tag, 8, 2).value_or(static_cast<uint32_t>(kCounts.size()));
  if (type >= kCounts.size()) return {};
  Parameters parameters = {};
  for (size_t i = 0; i < kCounts[type]; ++i) {
    const std::optional<double> value = Fixed(tag, 12 + 4 * i);
    if (!value) return {};
    parameters[i] = *value;
  }
  if (type == 0) return PowerCurve(parameters[0]);
  constexpr size_t kSamples = 257;
  return NameSampled(kSamples, [&](size_t i) {
    return ParametricValue(type, parameters,
                           static_cast<double>(i) / (kSamples - 1));
  });
}

Curve ReadCurve(std::string_view tag) {
  if (tag.substr(0, 4) == "curv") return TableCurve(tag);
  if (tag.substr(0, 4) == "para") return ParametricCurve(tag);
  return {};
}

// One curve for grey; three for colours, which must agree.
Curve ReadCurves(std::string_view bytes, bool grey) {
  if (grey) return ReadCurve(FindTag(bytes, "kTRC"));
  const Curve red = ReadCurve(FindTag(bytes, "rTRC"));
  for (const char* signature : {"gTRC", "bTRC"}) {
    const Curve other = ReadCurve(FindTag(bytes, signature));
    const bool same = other.kind == red.kind &&
                      std::fabs(other.exponent - red.exponent) < 1e-2;
    if (!same) return {};
  }
  return red;
}

// Whether colorants are there and are not sRGB's, adapted to D50.
bool HasOtherPrimaries(std::string_view bytes) {
  constexpr double kSrgb[3][3] = {{0.4361, 0.2225, 0.0139},
                                  {0.3851, 0.7169, 0.0971},
                                  {0.1431, 0.0606, 0.7141}};
  constexpr double kTolerance = 0.01;
  constexpr const char* kSignatures[] = {"rXYZ", "gXYZ", "bXYZ"};
  for (size_t i = 0; i < 3; ++i) {
    const std::string_view tag = FindTag(bytes, kSignatures[i]);
    for (size_t k = 0; k < 3; ++k) {
      const std::optional<double> value = Fixed(tag, 8 + 4 * k);
      if (value && std::fabs(*value - kSrgb[i][k]) > kTolerance) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<IccProfile> ParseIccProfile(std::string_view bytes) {
  if (bytes.size() < kIccHeaderBytes + 4 || bytes.substr(36, 4) != "acsp") {
    return std::nullopt;
  }
  IccProfile profile;
  profile.description = Description(FindTag(bytes, "desc"));
  profile.colour_space = Printable(std::string(bytes.substr(16, 4)));
  const Curve curve = ReadCurves(bytes, profile.colour_space == "GRAY");
  profile.curve = curve.kind;
  profile.exponent = curve.exponent;
  profile.other_primaries = HasOtherPrimaries(bytes);
  return profile;
}

}  // namespace ibrdf
