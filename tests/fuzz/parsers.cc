#include "tests/fuzz/parsers.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

#include "ibrdf/io/checksum.h"
#include "ibrdf/io/exif.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/icc_profile.h"
#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/photo_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/radiance_hdr.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/solver_trace.h"
#include "ibrdf/solvers/training/checkpoint.h"
#include "tests/support/png_crc.h"

namespace ibrdf {
namespace {

// What a small file claims beyond this is refused, as larger claims are with
// the limits of the programs: time goes into parsing, not into large images.
constexpr ImageLimits kLimits{256, 1 << 14};

void CheckError(const Status& status, const std::string& name) {
  CHECK(status.code() == StatusCode::kInvalidInput) << status.message();
  CHECK_NE(status.message().find(name), std::string::npos) << status.message();
  CHECK_EQ(status.message().find('\n'), std::string::npos) << status.message();
}

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

void CheckOneLine(const std::string& text) {
  for (const char c : text) CHECK_GE(static_cast<unsigned char>(c), 0x20);
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

// A table of few bins goes the way of a whole one.
void FuzzMerl(const std::string& bytes) {
  const StatusOr<std::vector<double>> raw =
      DecodeMerl("a.binary", bytes, kFuzzedMerlBins);
  if (!raw.ok()) return CheckError(raw.status(), "a.binary");
  CHECK_EQ(12 + 8 * raw->size(), bytes.size());
  for (const double value : *raw) CHECK(std::isfinite(value));
}

void FuzzMesh(const std::string& name, const std::string& bytes) {
  const StatusOr<TriangleMesh> mesh = DecodeMesh(name, bytes);
  if (!mesh.ok()) return CheckError(mesh.status(), name);
  CHECK(!mesh->triangles.empty());
  CHECK_EQ(mesh->normals.size(), mesh->vertices.size());
  for (const Eigen::Vector3f& v : mesh->vertices) CHECK(v.allFinite());
  // 1e-4: unit to float precision.
  for (const Eigen::Vector3f& n : mesh->normals) {
    CHECK_LT(std::fabs(n.norm() - 1.0f), 1e-4f) << n.transpose();
  }
  const int count = static_cast<int>(mesh->vertices.size());
  for (const auto& triangle : mesh->triangles) {
    for (const int v : triangle) CHECK(v >= 0 && v < count) << v;
  }
}

void FuzzProblem(const std::string& input) {
  std::vector<std::string> parts(1);
  for (const char c : input) {
    if (c == '\xff') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  const std::string text = parts[0];
  parts.erase(parts.begin());
  const StatusOr<Problem> problem = ParseProblem("a.yaml", text, parts);
  if (!problem.ok()) {
    // An override's error names the override instead.
    const bool of_override = problem.status().message().find("--set ") == 0;
    return CheckError(problem.status(), of_override ? "--set" : "a.yaml");
  }
  CHECK(IsValidCamera(problem->camera));
  CHECK_GT(problem->solver.seconds, 0.0);
  CHECK(problem->reflectance.lobes >= 1 && problem->reflectance.lobes <= 8);
  for (const Status& status :
       {CheckSolvable(*problem), CheckRenderable(*problem)}) {
    if (!status.ok()) CheckError(status, "a.yaml");
  }
}

// After the first byte; where that is odd, with the checksum that fits.
std::string WithChecksum(const std::string& input) {
  std::string bytes = input.substr(1);
  if (input[0] & 1) {
    const uint64_t checksum = Fnv1a(bytes.data(), bytes.size());
    bytes.append(reinterpret_cast<const char*>(&checksum), sizeof(checksum));
  }
  return bytes;
}

void FuzzCheckpoint(const std::string& input) {
  if (input.empty()) return;
  TrainingState state = FuzzedTrainingState();
  const Status status = DecodeCheckpoint("a.checkpoint", WithChecksum(input),
                                         kFuzzedTraining, &state);
  const TrainingState whole = FuzzedTrainingState();
  CHECK_EQ(state.weights.size(), whole.weights.size());
  CHECK_EQ(state.code_steps.size(), whole.code_steps.size());
  if (status.ok()) return;
  CheckError(status, "a.checkpoint");
  CHECK(state.weights == whole.weights && state.step == whole.step);
}

void FuzzResults(const std::string& text) {
  const std::vector<std::string>& columns = FuzzedColumns();
  const auto rows = DecodeResults("a.csv", text, columns);
  if (!rows.ok()) return CheckError(rows.status(), "a.csv");
  for (const ResultsRow& row : *rows) CHECK_EQ(row.size(), columns.size());
}

void FuzzTrace(const std::string& text) {
  const auto trace = DecodeTrace("result.json", text);
  if (!trace.ok()) return CheckError(trace.status(), "result.json");
  CHECK(!trace->empty());
  for (const TraceLine& line : *trace) {
    CHECK(std::isfinite(line.seconds) && std::isfinite(line.misfit));
  }
  CHECK_LE(CountIterations(*trace), static_cast<int>(trace->size()));
}

void FuzzModel(const std::string& input) {
  if (input.empty()) return;
  const std::string bytes = WithChecksum(input);
  const StatusOr<NeuralBrdfModel> model = DecodeModel("a.ibrdf", bytes);
  if (!model.ok()) return CheckError(model.status(), "a.ibrdf");
  CHECK_EQ(model->shape.Validate(), "");
  CHECK_EQ(model->weights.size(), model->shape.NumWeights());
  CHECK_EQ(model->codes.size(), model->names.size() * model->shape.code_size());
  for (const float w : model->weights) CHECK(std::isfinite(w));
}

struct Parser {
  const char* name;
  std::function<void(const std::string&)> run;
};

const std::vector<Parser>& Parsers() {
  static const std::vector<Parser> parsers = {
      {"exr", FuzzExr},
      {"hdr", FuzzHdr},
      {"png", FuzzPng},
      {"photo_png", FuzzPhotoPng},
      {"photo_jpeg",
       [](const std::string& b) { FuzzPhoto(b, "\xff\xd8\xff"); }},
      // Of either byte order: the first bytes stay.
      {"photo_tiff", [](const std::string& b) { FuzzPhoto(b, ""); }},
      {"photo_exr", FuzzPhotoExr},
      {"npy", [](const std::string& b) { FuzzPhoto(b, "\x93NUMPY"); }},
      {"pfm", [](const std::string& b) { FuzzPhoto(b, "P"); }},
      {"exif", FuzzExif},
      {"icc", FuzzIcc},
      {"merl", FuzzMerl},
      {"obj", [](const std::string& b) { FuzzMesh("a.obj", b); }},
      {"ply", [](const std::string& b) { FuzzMesh("a.ply", b); }},
      {"problem", FuzzProblem},
      {"model", FuzzModel},
      {"checkpoint", FuzzCheckpoint},
      {"results", FuzzResults},
      {"trace", FuzzTrace}};
  return parsers;
}

}  // namespace

const std::vector<std::string>& FuzzedColumns() {
  static const std::vector<std::string> columns = {"case", "seconds", "error"};
  return columns;
}

TrainingState FuzzedTrainingState() {
  TrainingState state;
  state.step = 7;
  state.weights = {1.0f, 2.0f, 3.0f};
  state.codes = {4.0f, 5.0f};
  for (Adam* adam : {&state.weight_adam, &state.code_adam}) {
    const size_t size = adam == &state.weight_adam ? 3 : 2;
    adam->mean.assign(size, 0.5f);
    adam->square.assign(size, 0.25f);
  }
  state.code_steps = {7};
  return state;
}

const std::vector<std::string>& FuzzedParsers() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Parser& parser : Parsers()) out.emplace_back(parser.name);
    return out;
  }();
  return names;
}

void FuzzParser(const std::string& parser, const uint8_t* input, size_t size) {
  for (const Parser& p : Parsers()) {
    if (parser != p.name) continue;
    p.run(std::string(reinterpret_cast<const char*>(input), size));
    return;
  }
  LOG(FATAL) << "no parser " << parser;
}

}  // namespace ibrdf
