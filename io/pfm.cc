#include "ibrdf/io/pfm.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace ibrdf {
namespace {

bool IsSpace(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

// The next word of the header and one white space after it; empty at the end,
// and where it is longer than a number.
std::string NextWord(const std::string& bytes, size_t* at) {
  constexpr size_t kMaxWord = 30;
  while (*at < bytes.size() && IsSpace(bytes[*at])) ++*at;
  const size_t start = *at;
  while (*at < bytes.size() && !IsSpace(bytes[*at])) {
    if (*at - start == kMaxWord) return "";
    ++*at;
  }
  const std::string word = bytes.substr(start, *at - start);
  ++*at;
  return word;
}

// 0 where the word is no whole number of at most 9 digits.
int64_t ParsePfmSize(const std::string& word) {
  if (word.empty() || word.size() > 9) return 0;
  for (const char c : word) {
    if (c < '0' || c > '9') return 0;
  }
  return std::atoll(word.c_str());
}

float PfmValue(const char* data, bool little_endian) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 4; ++i) {
    const size_t digit = little_endian ? 3 - i : i;
    bits = bits << 8 | static_cast<uint8_t>(data[digit]);
  }
  float value = 0.0f;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

}  // namespace

StatusOr<Photo> DecodePfm(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits) {
  size_t at = 0;
  const std::string kind = NextWord(bytes, &at);
  if (kind != "PF" && kind != "Pf") {
    return InvalidInput(path, "expected a PFM image, which starts PF or Pf");
  }
  const int64_t width = ParsePfmSize(NextWord(bytes, &at));
  const int64_t height = ParsePfmSize(NextWord(bytes, &at));
  IBRDF_RETURN_IF_ERROR(CheckImageSize(path, width, height, limits));
  const std::string scale_word = NextWord(bytes, &at);
  char* end = nullptr;
  const double scale = std::strtod(scale_word.c_str(), &end);
  if (scale_word.empty() || *end != '\0' || !std::isfinite(scale) ||
      scale == 0.0) {
    return InvalidInput(path + ": scale", "expected a number other than 0");
  }
  const bool grey = kind == "Pf";
  const size_t row_values = static_cast<size_t>(width) * (grey ? 1 : 3);
  const size_t count = row_values * static_cast<size_t>(height);
  if (at > bytes.size() || (bytes.size() - at) / sizeof(float) < count) {
    return InvalidInput(
        path, "truncated PFM, expected " + std::to_string(count) + " values");
  }

  Photo photo;
  photo.format = PhotoFormat::kPfm;
  photo.grey = grey;
  photo.image = Image(static_cast<int>(width), static_cast<int>(height));
  const bool little_endian = scale < 0.0;
  for (size_t i = 0; i < photo.image.rgb.size(); ++i) {
    const size_t pixel = i / 3;
    const size_t x = pixel % static_cast<size_t>(width);
    const size_t row =
        static_cast<size_t>(height) - 1 - pixel / static_cast<size_t>(width);
    const size_t value = row * row_values + (grey ? x : 3 * x + i % 3);
    photo.image.rgb[i] =
        PfmValue(bytes.data() + at + value * sizeof(float), little_endian);
  }
  if (std::fabs(scale) != 1.0) {
    photo.notes.push_back("The PFM scale " + Printable(scale_word) +
                          " was not applied.");
  }
  photo.curve = {CurveKind::kLinear, 1.0, "PFM"};
  return photo;
}

}  // namespace ibrdf
