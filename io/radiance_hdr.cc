#include "ibrdf/io/radiance_hdr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "ibrdf/io/atomic_file.h"

namespace ibrdf {
namespace {

using Rgbe = std::array<uint8_t, 4>;

// Widths a run-length encoded scanline of the new kind can announce.
constexpr int kMinRleWidth = 8;
constexpr int kMaxRleWidth = 32767;
constexpr int kExponentBias = 128 + 8;  // 8: the mantissa is an integer

struct HdrHeader {
  int width = 0;
  int height = 0;
  std::array<double, 3> exposure = {1.0, 1.0, 1.0};
  size_t end = 0;  // first byte of the pixels
};

// Multiplies the numbers of a line's value into `exposure`: one for all
// channels, or three.
Status ApplyExposure(const std::string& where, const std::string& value,
                     size_t count, std::array<double, 3>* exposure) {
  const char* text = value.c_str();
  for (size_t i = 0; i < count; ++i) {
    char* end = nullptr;
    const double x = std::strtod(text, &end);
    if (end == text || !std::isfinite(x) || x <= 0.0) {
      return InvalidInput(
          where, "expected " + std::to_string(count) + " positive number(s)");
    }
    text = end;
    for (size_t c = 0; c < 3; ++c) {
      if (count == 1 || c == i) (*exposure)[c] *= x;
    }
  }
  for (const double e : *exposure) {
    if (!std::isfinite(e) || e <= 0.0) {
      return InvalidInput(where, "expected a finite product of exposures");
    }
  }
  return OkStatus();
}

// A size of at most 9 digits at *position, followed by a space or the end.
bool ParseSize(const std::string& line, size_t* position, int64_t* size) {
  const size_t start = *position;
  *size = 0;
  while (*position < line.size() && line[*position] >= '0' &&
         line[*position] <= '9' && *position - start < 9) {
    *size = *size * 10 + (line[(*position)++] - '0');
  }
  return *position > start;
}

Status ParseResolution(const std::string& path, const std::string& line,
                       const ImageLimits& limits, HdrHeader* header) {
  const std::string where = path + ": resolution";
  int64_t height = 0, width = 0;
  size_t position = 3;
  const bool parsed =
      line.compare(0, 3, "-Y ") == 0 && ParseSize(line, &position, &height) &&
      line.compare(position, 4, " +X ") == 0 &&
      ParseSize(line, &(position += 4), &width) && position == line.size();
  if (!parsed) {
    return InvalidInput(where, "expected \"-Y height +X width\", found \"" +
                                   line.substr(0, 60) + "\"");
  }
  IBRDF_RETURN_IF_ERROR(CheckImageSize(path, width, height, limits));
  header->width = static_cast<int>(width);
  header->height = static_cast<int>(height);
  return OkStatus();
}

StatusOr<HdrHeader> ParseHdrHeader(const std::string& path,
                                   const std::string& bytes,
                                   const ImageLimits& limits) {
  if (bytes.compare(0, 2, "#?") != 0) {
    return InvalidInput(path, "expected a Radiance image, which starts \"#?\"");
  }
  HdrHeader header;
  bool first = true, blank = false;
  while (header.end < bytes.size()) {
    const size_t newline = bytes.find('\n', header.end);
    if (newline == std::string::npos) break;
    std::string line = bytes.substr(header.end, newline - header.end);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    header.end = newline + 1;
    if (first) {
      first = false;
    } else if (blank) {
      IBRDF_RETURN_IF_ERROR(ParseResolution(path, line, limits, &header));
      return header;
    } else if (line.empty()) {
      blank = true;
    } else if (line.compare(0, 7, "FORMAT=") == 0) {
      const size_t end = line.find_last_not_of(" \t");
      if (line.substr(7, end - 6) != "32-bit_rle_rgbe") {
        return InvalidInput(
            path + ": FORMAT",
            "expected 32-bit_rle_rgbe, found " + line.substr(7, 60));
      }
    } else if (line.compare(0, 9, "EXPOSURE=") == 0) {
      IBRDF_RETURN_IF_ERROR(ApplyExposure(path + ": EXPOSURE", line.substr(9),
                                          1, &header.exposure));
    } else if (line.compare(0, 10, "COLORCORR=") == 0) {
      IBRDF_RETURN_IF_ERROR(ApplyExposure(path + ": COLORCORR", line.substr(10),
                                          3, &header.exposure));
    }
  }
  return InvalidInput(path,
                      "truncated header, expected a blank line and "
                      "\"-Y height +X width\"");
}

// Reads scanlines one after another; false at the first that is malformed or
// cut off.
class ScanlineReader {
 public:
  ScanlineReader(const std::string& bytes, size_t position)
      : bytes_(bytes), position_(position) {}

  bool Read(std::vector<Rgbe>* line) {
    const int width = static_cast<int>(line->size());
    if (width < kMinRleWidth || width > kMaxRleWidth || Left() < 4 ||
        Peek(0) != 2 || Peek(1) != 2 || Peek(2) >= 128) {
      return ReadOld(line);
    }
    if (Peek(2) * 256 + Peek(3) != width) return false;
    position_ += 4;
    return ReadNew(line);
  }

 private:
  size_t Left() const { return bytes_.size() - position_; }
  int Peek(size_t offset) const {
    return static_cast<uint8_t>(bytes_[position_ + offset]);
  }

  // Four planes of runs (count > 128: count - 128 copies) and literals.
  bool ReadNew(std::vector<Rgbe>* line) {
    for (size_t plane = 0; plane < 4; ++plane) {
      for (size_t x = 0; x < line->size();) {
        if (Left() < 2) return false;
        const int code = Peek(0);
        ++position_;
        const bool run = code > 128;
        const size_t count = static_cast<size_t>(run ? code - 128 : code);
        if (count == 0 || count > line->size() - x) return false;
        if (Left() < (run ? 1 : count)) return false;
        for (size_t i = 0; i < count; ++i) {
          (*line)[x++][plane] = static_cast<uint8_t>(Peek(run ? 0 : i));
        }
        position_ += run ? 1 : count;
      }
    }
    return true;
  }

  // Flat pixels, where 1 1 1 n repeats the last one n times; n of directly
  // following repeats count 256 times as much each.
  bool ReadOld(std::vector<Rgbe>* line) {
    int shift = 0;
    for (size_t x = 0; x < line->size();) {
      if (Left() < 4) return false;
      Rgbe pixel;
      for (size_t i = 0; i < 4; ++i) pixel[i] = static_cast<uint8_t>(Peek(i));
      position_ += 4;
      if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
        (*line)[x++] = pixel;
        shift = 0;
        continue;
      }
      if (x == 0 || shift > 16) return false;
      const size_t count = static_cast<size_t>(pixel[3]) << shift;
      if (count > line->size() - x) return false;
      const Rgbe last = (*line)[x - 1];
      for (size_t i = 0; i < count; ++i) (*line)[x++] = last;
      shift += 8;
    }
    return true;
  }

  const std::string& bytes_;
  size_t position_;
};

// Negative values and NaN become 0. Not by fmax, which keeps a signalling NaN.
float Held(float value) { return value > 0.0f ? value : 0.0f; }

uint8_t Mantissa(float value, double scale) {
  return static_cast<uint8_t>(
      std::min(std::floor(Held(value) * scale + 0.5), 255.0));
}

Rgbe ToRgbe(const float* rgb) {
  const float largest = std::max({Held(rgb[0]), Held(rgb[1]), Held(rgb[2])});
  if (largest <= 0.0f) return {0, 0, 0, 0};
  int exponent = 128;
  if (std::isfinite(largest)) {
    const float fraction = std::frexp(largest, &exponent);
    // Rounds up to the next power of two.
    if (fraction * 256.0f >= 255.5f) ++exponent;
  }
  if (exponent < -127) return {0, 0, 0, 0};
  exponent = std::min(exponent, 127);
  const double scale = std::ldexp(1.0, 8 - exponent);
  return {Mantissa(rgb[0], scale), Mantissa(rgb[1], scale),
          Mantissa(rgb[2], scale), static_cast<uint8_t>(exponent + 128)};
}

// Appends one plane of a scanline as runs of 4 or more and literals.
void AppendPlane(const std::vector<Rgbe>& line, size_t plane,
                 std::string* bytes) {
  constexpr size_t kMinRun = 4, kMaxRun = 127, kMaxLiteral = 128;
  const auto run_at = [&](size_t x) {
    size_t n = 1;
    while (n < kMaxRun && x + n < line.size() &&
           line[x + n][plane] == line[x][plane]) {
      ++n;
    }
    return n;
  };
  for (size_t x = 0; x < line.size();) {
    const size_t run = run_at(x);
    if (run >= kMinRun) {
      bytes->push_back(static_cast<char>(128 + run));
      bytes->push_back(static_cast<char>(line[x][plane]));
      x += run;
      continue;
    }
    size_t end = x + 1;
    while (end < line.size() && end - x < kMaxLiteral &&
           run_at(end) < kMinRun) {
      ++end;
    }
    bytes->push_back(static_cast<char>(end - x));
    for (; x < end; ++x) bytes->push_back(static_cast<char>(line[x][plane]));
  }
}

}  // namespace

StatusOr<Image> ReadRadianceHdr(const std::string& path) {
  const StatusOr<std::string> bytes = ReadFile(path, kMaxImageFileBytes);
  if (!bytes.ok()) return bytes.status();
  return DecodeRadianceHdr(path, *bytes);
}

StatusOr<Image> DecodeRadianceHdr(const std::string& path,
                                  const std::string& bytes,
                                  const ImageLimits& limits) {
  const StatusOr<HdrHeader> header = ParseHdrHeader(path, bytes, limits);
  if (!header.ok()) return header.status();

  Image image;
  image.width = header->width;
  image.height = header->height;
  ScanlineReader reader(bytes, header->end);
  std::vector<Rgbe> line(static_cast<size_t>(image.width));
  // Grows by scanlines, so that a small file cannot claim much memory.
  for (int y = 0; y < image.height; ++y) {
    if (!reader.Read(&line)) {
      return InvalidInput(path + ": scanline " + std::to_string(y),
                          "expected " + std::to_string(image.width) +
                              " encoded pixels, found damage or the end");
    }
    for (const Rgbe& pixel : line) {
      for (size_t c = 0; c < 3; ++c) {
        const double value =
            pixel[3] == 0 ? 0.0
                          : std::ldexp(pixel[c], pixel[3] - kExponentBias);
        image.rgb.push_back(static_cast<float>(value / header->exposure[c]));
      }
    }
  }
  return image;
}

Status WriteRadianceHdr(const Image& image, const std::string& path) {
  IBRDF_RETURN_IF_ERROR(
      CheckWritable(path, image.width, image.height, image.rgb.size()));
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                      std::to_string(image.height) + " +X " +
                      std::to_string(image.width) + "\n";
  std::vector<Rgbe> line(static_cast<size_t>(image.width));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) line[x] = ToRgbe(image.At(x, y));
    if (image.width < kMinRleWidth || image.width > kMaxRleWidth) {
      for (const Rgbe& pixel : line) bytes.append(pixel.begin(), pixel.end());
      continue;
    }
    bytes += {2, 2, static_cast<char>(image.width >> 8),
              static_cast<char>(image.width & 255)};
    for (size_t plane = 0; plane < 4; ++plane) {
      AppendPlane(line, plane, &bytes);
    }
  }
  return WriteFileAtomically(path, bytes);
}

}  // namespace ibrdf
