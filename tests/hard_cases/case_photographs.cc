#include "tests/hard_cases/case_photographs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ibrdf/image/response_curve.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/file_extension.h"
#include "tests/hard_cases/recipe_value.h"
#include "tests/support/photo_files.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

StatusOr<std::vector<uint16_t>> Encode(const YAML::Node& codes,
                                       const Image& image) {
  const int bits = Get(codes, "bits", 8);
  const double most = std::exp2(bits) - 1.0;
  ResponseDefinition definition;
  const StatusOr<ResponseKind> kind =
      ResponseKindOf("recipe: curve", Get(codes, "curve", std::string("srgb")));
  if (!kind.ok()) return kind.status();
  definition.kind = *kind;
  if (codes["parameter"])
    definition.parameter = codes["parameter"].as<double>();
  IBRDF_RETURN_IF_ERROR(definition.Check("recipe: parameter"));
  const ResponseCurve curve(definition);
  const double exposure = Get(codes, "exposure", 1.0);
  std::vector<uint16_t> out;
  for (const float v : image.rgb) {
    const double y = codes["code"] ? codes["code"].as<double>() / most
                                   : curve.Encode(exposure * std::max(v, 0.0f));
    out.push_back(static_cast<uint16_t>(
        std::lround(most * std::min(std::isfinite(y) ? y : 1.0, 1.0))));
  }
  return out;
}

std::string Png(const YAML::Node& recipe, const Image& image,
                const std::vector<uint16_t>& codes) {
  PngSpec spec;
  spec.width = image.width;
  spec.height = image.height;
  spec.bits = Get(recipe, "bits", 8);
  const bool grey = Get(recipe, "grey", false);
  if (grey) spec.type = PNG_COLOR_TYPE_GRAY;
  if (recipe["alpha"]) spec.type = PNG_COLOR_TYPE_RGB_ALPHA;
  const size_t bytes = spec.bits > 8 ? 2 : 1;
  for (size_t k = 0; k < codes.size(); ++k) {
    if (grey && k % 3 != 1) continue;
    spec.rows += BigEndianBytes(codes[k], bytes);
    if (recipe["alpha"] && k % 3 == 2) {
      spec.rows += BigEndianBytes(recipe["alpha"].as<uint32_t>(), bytes);
    }
  }
  if (recipe["gamma"]) {
    spec.before.push_back(
        {"gAMA", BigEndianBytes(static_cast<uint32_t>(std::lround(
                                    1e5 * recipe["gamma"].as<double>())),
                                4)});
  }
  if (recipe["sbit"]) {
    const char bits = static_cast<char>(recipe["sbit"].as<int>());
    spec.before.push_back({"sBIT", std::string(3, bits)});
  }
  if (recipe["icc"]) {
    spec.before.push_back(
        {"iCCP", std::string("icc\0\0", 5) +
                     ZlibBytes(recipe["icc"].as<std::string>())});
  }
  return PngBytes(spec);
}

std::string Jpeg(const YAML::Node& recipe, const Image& image,
                 const std::vector<uint16_t>& codes) {
  JpegSpec spec;
  spec.width = image.width;
  spec.height = image.height;
  spec.quality = Get(recipe, "quality", 90);
  spec.subsample = true;
  if (Get(recipe, "cmyk", false)) {
    spec.channels = 4;
    spec.colours = JCS_CMYK;
    spec.subsample = false;
  }
  for (size_t k = 0; k < codes.size(); ++k) {
    spec.values.push_back(static_cast<uint8_t>(codes[k]));
    if (spec.channels == 4 && k % 3 == 2) spec.values.push_back(0);
  }
  if (recipe["orientation"]) {
    spec.markers.push_back(
        ExifMarker(ExifOfOrientation(recipe["orientation"].as<int>())));
  }
  return JpegBytes(spec);
}

void Tiff(const YAML::Node& recipe, const Image& image,
          const std::vector<uint16_t>& codes, const std::string& path) {
  TiffSpec spec;
  spec.width = image.width;
  spec.height = image.height;
  spec.bits = Get(recipe, "bits", 8);
  spec.orientation = Get(recipe, "orientation", 0);
  for (const uint16_t code : codes) {
    spec.values += LittleEndianBytes(code, spec.bits > 8 ? 2 : 1);
  }
  WriteTiff(path, {spec});
}

}  // namespace

Status MakePhotograph(const YAML::Node& codes, const Image& image,
                      const std::string& path) {
  const StatusOr<std::vector<uint16_t>> encoded = Encode(codes, image);
  if (!encoded.ok()) return encoded.status();
  const std::string format = FileExtension(path);
  if (format == "tif") {
    Tiff(codes, image, *encoded, path);
  } else if (format == "png") {
    WriteBytes(path, Png(codes, image, *encoded));
  } else if (format == "jpg") {
    WriteBytes(path, Jpeg(codes, image, *encoded));
  } else {
    return InvalidInput("recipe", path + ": expected .png, .jpg or .tif");
  }
  if (!codes["cut"] && !codes["damage"]) return OkStatus();
  StatusOr<std::string> bytes = ReadFile(path, size_t{1} << 24);
  if (!bytes.ok()) return bytes.status();
  if (codes["cut"]) bytes->resize(codes["cut"].as<size_t>());
  if (codes["damage"]) bytes->at(codes["damage"].as<size_t>()) ^= 0x55;
  WriteBytes(path, *bytes);
  return OkStatus();
}

}  // namespace ibrdf
