#include "tests/fuzz/parsers.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <sstream>

#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/checksum.h"
#include "ibrdf/io/config_text.h"
#include "ibrdf/io/config_tree.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/solver_trace.h"
#include "ibrdf/solvers/programs/problem_from_flags.h"
#include "ibrdf/solvers/training/checkpoint.h"
#include "tests/fuzz/image_parsers.h"
#include "tests/fuzz/parser_checks.h"
#include "tests/support/mesh_files.h"

namespace ibrdf {
namespace {

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
  CHECK(mesh->texture.empty() ||
        mesh->texture.size() == mesh->triangles.size());
  for (const auto& corners : mesh->texture) {
    for (const Eigen::Vector2f& uv : corners) CHECK(uv.allFinite());
  }
  const int count = static_cast<int>(mesh->vertices.size());
  for (const auto& triangle : mesh->triangles) {
    for (const int v : triangle) CHECK(v >= 0 && v < count) << v;
  }
}

// Counts of a GLB's container that fit, so that what is behind them is reached:
// where the first byte is odd, the rest is JSON up to a byte 0xff, then the
// buffer.
void FuzzGlb(const std::string& input) {
  if (input.empty()) return;
  const std::string rest = input.substr(1);
  if ((input[0] & 1) == 0) return FuzzMesh("a.glb", rest);
  const size_t split = std::min(rest.find('\xff'), rest.size());
  FuzzMesh("a.glb", GlbOf(rest.substr(0, split),
                          rest.substr(std::min(split + 1, rest.size()))));
}

// Split at bytes 0xff.
std::vector<std::string> Parts(const std::string& input) {
  std::vector<std::string> parts(1);
  for (const char c : input) {
    if (c == '\xff') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

void FuzzViews(const StatusOr<std::vector<CalibratedView>>& views,
               const std::string& name) {
  if (!views.ok()) return CheckError(views.status(), name);
  CHECK(!views->empty() && views->size() <= kMaxViews);
  std::set<std::string> names;
  for (const CalibratedView& view : *views) {
    CHECK_EQ(ViewNameFault(view.name), "");
    CHECK(names.insert(view.name).second) << view.name;
    const StatusOr<Camera> camera = CameraOf(view, 64, 48);
    if (camera.ok()) {
      CHECK_EQ(PoseFault(*camera->world_from_camera), "");
    } else {
      CheckError(camera.status(), "image");
    }
  }
}

void FuzzColmap(const std::string& input) {
  std::vector<std::string> files = Parts(input);
  files.resize(2);
  FuzzViews(
      ParseColmapText({"cameras.txt", files[0]}, {"images.txt", files[1]}),
      ".txt");
}

// The first two bytes are the size of the first file.
void FuzzColmapBinary(const std::string& input) {
  if (input.size() < 2) return;
  const size_t size =
      static_cast<uint8_t>(input[0]) + 256u * static_cast<uint8_t>(input[1]);
  const std::string rest = input.substr(2);
  const size_t split = std::min(size, rest.size());
  FuzzViews(ParseColmapBinary({"cameras.bin", rest.substr(0, split)},
                              {"images.bin", rest.substr(split)}),
            ".bin");
}

bool SameTree(const ConfigNode& a, const ConfigNode& b) {
  bool same = a.kind == b.kind && a.scalar == b.scalar &&
              a.items.size() == b.items.size() &&
              a.entries.size() == b.entries.size();
  for (size_t i = 0; same && i < a.items.size(); ++i) {
    same = SameTree(a.items[i], b.items[i]);
  }
  for (size_t i = 0; same && i < a.entries.size(); ++i) {
    same = a.entries[i].first == b.entries[i].first &&
           SameTree(a.entries[i].second, b.entries[i].second);
  }
  return same;
}

// What is written of a tree is the tree.
void FuzzConfig(const std::string& text) {
  const StatusOr<ConfigNode> tree = ParseConfig("a.yaml", text);
  if (!tree.ok()) return CheckError(tree.status(), "a.yaml");
  if (tree->kind != ConfigNode::Kind::kMap) return;
  const std::string written = ConfigText(*tree);
  const StatusOr<ConfigNode> back = ParseConfig("b.yaml", written);
  CHECK(back.ok()) << back.status().message() << "\n" << written;
  CHECK(SameTree(*tree, *back)) << written;
}

void FuzzFlags(const std::string& input) {
  std::vector<std::string> parts = Parts(input);
  ProblemFlags flags;
  // Several photographs are one to a line.
  std::istringstream photos(parts.front());
  for (std::string line; std::getline(photos, line);) {
    flags.photos.push_back(line);
  }
  size_t next = 1;
  for (std::string* const flag : {&flags.mask, &flags.response, &flags.normals,
                                  &flags.mesh, &flags.known_light}) {
    if (next < parts.size()) *flag = parts[next++];
  }
  flags.overrides.assign(parts.begin() + static_cast<std::ptrdiff_t>(next),
                         parts.end());
  flags.command = ShellCommand(parts);
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  if (!made.ok()) {
    const bool of_override = made.status().message().find("--set ") == 0;
    return CheckError(made.status(), of_override ? "--set" : "command line");
  }
  const StatusOr<Problem> again =
      ParseProblem("out/problem.yaml", made->text, {});
  CHECK(again.ok()) << again.status().message();
}

void FuzzProblem(const std::string& input) {
  std::vector<std::string> parts = Parts(input);
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

const std::vector<FuzzedParser>& Parsers() {
  static const std::vector<FuzzedParser> parsers = [] {
    std::vector<FuzzedParser> all = ImageParsers();
    const std::vector<FuzzedParser> others = {
        {"merl", FuzzMerl},
        {"obj", [](const std::string& b) { FuzzMesh("a.obj", b); }},
        {"ply", [](const std::string& b) { FuzzMesh("a.ply", b); }},
        {"stl", [](const std::string& b) { FuzzMesh("a.stl", b); }},
        {"glb", FuzzGlb},
        {"transforms",
         [](const std::string& b) {
           FuzzViews(ParseTransforms("a.json", b), "a.json");
         }},
        {"colmap_text", FuzzColmap},
        {"colmap_binary", FuzzColmapBinary},
        {"config", FuzzConfig},
        {"flags", FuzzFlags},
        {"problem", FuzzProblem},
        {"model", FuzzModel},
        {"checkpoint", FuzzCheckpoint},
        {"results", FuzzResults},
        {"trace", FuzzTrace}};
    all.insert(all.end(), others.begin(), others.end());
    return all;
  }();
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
    for (const FuzzedParser& parser : Parsers()) out.emplace_back(parser.name);
    return out;
  }();
  return names;
}

void FuzzParser(const std::string& parser, const uint8_t* input, size_t size) {
  for (const FuzzedParser& p : Parsers()) {
    if (parser != p.name) continue;
    p.run(std::string(reinterpret_cast<const char*>(input), size));
    return;
  }
  LOG(FATAL) << "no parser " << parser;
}

}  // namespace ibrdf
