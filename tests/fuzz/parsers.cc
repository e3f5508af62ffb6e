#include "tests/fuzz/parsers.h"

#include <fcntl.h>
#include <glog/logging.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <utility>

#include "io/checksum.h"
#include "io/exr.h"
#include "io/image_limits.h"
#include "io/merl.h"
#include "io/mesh.h"
#include "io/model_file.h"
#include "io/png.h"
#include "io/problem_file.h"
#include "io/radiance_hdr.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// One file of this process, in memory where the system has such a folder.
class InputFile {
 public:
  explicit InputFile(const std::string& name) {
    const bool in_memory = ::access("/dev/shm", W_OK) == 0;
    if (in_memory) ::setenv("TMPDIR", "/dev/shm", 0);
    dir_ = std::make_unique<TempDir>();
    path_ = dir_->File(name);
  }
  const std::string& Write(const char* bytes, size_t size) const {
    const int file =
        ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    CHECK_GE(file, 0) << path_;
    CHECK_EQ(::write(file, bytes, size), static_cast<ssize_t>(size));
    CHECK_EQ(::close(file), 0);
    return path_;
  }

 private:
  std::unique_ptr<TempDir> dir_;
  std::string path_;
};

// The file of that name, made at first use, removed at the end.
const std::string& WriteInput(const std::string& name, const std::string& b) {
  static std::vector<std::pair<std::string, std::unique_ptr<InputFile>>> files;
  for (const auto& [known, file] : files) {
    if (known == name) return file->Write(b.data(), b.size());
  }
  files.emplace_back(name, std::make_unique<InputFile>(name));
  return files.back().second->Write(b.data(), b.size());
}

void CheckError(const Status& status, const std::string& name) {
  CHECK(status.code() == StatusCode::kInvalidInput) << status.message();
  CHECK_NE(status.message().find(name), std::string::npos) << status.message();
  CHECK_EQ(status.message().find('\n'), std::string::npos) << status.message();
}

void CheckImage(const StatusOr<Image>& image, const std::string& name) {
  if (!image.ok()) return CheckError(image.status(), name);
  CHECK(CheckImageSize(name, image->width, image->height).ok());
  CHECK_EQ(image->rgb.size(), 3 * image->num_pixels());
}

void FuzzExr(const std::string& bytes) {
  CheckImage(ReadExr(WriteInput("a.exr", bytes)), "a.exr");
}

void FuzzHdr(const std::string& bytes) {
  const StatusOr<Image> image = ReadRadianceHdr(WriteInput("a.hdr", bytes));
  CheckImage(image, "a.hdr");
  if (!image.ok()) return;
  for (const float value : image->rgb) CHECK(!std::isnan(value) && value >= 0);
}

void FuzzPng(const std::string& bytes) {
  const StatusOr<Mask> mask = ReadMask(WriteInput("a.png", bytes));
  if (!mask.ok()) return CheckError(mask.status(), "a.png");
  CHECK(CheckImageSize("a.png", mask->width, mask->height).ok());
  CHECK_EQ(mask->inside.size(),
           static_cast<size_t>(mask->width) * mask->height);
  for (const uint8_t v : mask->inside) CHECK_LE(v, 1);
}

// The bytes of a table of ones.
const std::string& ValidMerl() {
  static const std::string bytes = [] {
    const TempDir dir;
    MerlTable table;
    table.raw.assign(size_t{3} * kMerlBins, 1.0);
    CHECK(WriteMerl(table, dir.File("a.binary")).ok());
    return ReadBytes(dir.File("a.binary"));
  }();
  return bytes;
}

void FuzzMerl(const std::string& input) {
  if (input.empty()) return;
  std::string bytes = input.substr(1);
  if (input[0] & 1) {
    std::string patched = ValidMerl();
    for (size_t i = 0; i + 12 <= bytes.size(); i += 12) {
      uint32_t at = 0;
      std::memcpy(&at, bytes.data() + i, sizeof(at));
      std::memcpy(&patched[at % (patched.size() - 8)], bytes.data() + i + 4, 8);
    }
    bytes = std::move(patched);
  }
  const StatusOr<MerlTable> table = ReadMerl(WriteInput("a.binary", bytes));
  if (!table.ok()) return CheckError(table.status(), "a.binary");
  CHECK_EQ(table->raw.size(), size_t{3} * kMerlBins);
  for (const double value : table->raw) CHECK(std::isfinite(value));
}

void FuzzMesh(const std::string& name, const std::string& bytes) {
  const StatusOr<TriangleMesh> mesh = ReadMesh(WriteInput(name, bytes));
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
  const std::string& path = WriteInput("a.yaml", parts[0]);
  parts.erase(parts.begin());
  const StatusOr<Problem> problem = ReadProblem(path, parts);
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

void FuzzModel(const std::string& input) {
  if (input.empty()) return;
  std::string bytes = input.substr(1);
  if (input[0] & 1) {
    const uint64_t checksum = Fnv1a(bytes.data(), bytes.size());
    bytes.append(reinterpret_cast<const char*>(&checksum), sizeof(checksum));
  }
  const StatusOr<NeuralBrdfModel> model =
      ReadModel(WriteInput("a.ibrdf", bytes));
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
      {"merl", FuzzMerl},
      {"obj", [](const std::string& b) { FuzzMesh("a.obj", b); }},
      {"ply", [](const std::string& b) { FuzzMesh("a.ply", b); }},
      {"problem", FuzzProblem},
      {"model", FuzzModel}};
  return parsers;
}

}  // namespace

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
