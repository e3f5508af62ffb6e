#include "solvers/bench/joint_sweep.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "io/atomic_file.h"
#include "io/image_file.h"
#include "io/merl.h"
#include "io/png.h"
#include "solvers/baselines/cook_torrance_fit.h"
#include "solvers/bench/child_process.h"
#include "solvers/bench/sweep_files.h"
#include "solvers/render_scene.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

// Size of the estimated map, and of the true one given to baselines.
constexpr int kMapWidth = 128;
constexpr int kMapHeight = 64;
constexpr size_t kMaxJsonBytes = size_t{1} << 28;

bool IsMesh(const JointSweepOptions& options) {
  return options.geometry != "sphere";
}

std::string GeometryName(const JointSweepOptions& options) {
  return IsMesh(options) ? fs::path(options.geometry).stem().string()
                         : options.geometry;
}

// A JSON string is a YAML string too.
std::string Quoted(const std::string& text) {
  return nlohmann::json(text).dump();
}

Problem RenderProblem(const JointSweepOptions& options, const JointCase& c) {
  Problem problem;
  problem.path = c.name;
  problem.image.width = problem.image.height = options.size;
  if (IsMesh(options)) {
    problem.geometry.kind = GeometryKind::kMesh;
    problem.geometry.file = options.geometry;
  }
  problem.reflectance.known_file = c.brdf_path;
  problem.illumination.known_file = c.map_path;
  problem.quality = RenderQuality::kReference;
  problem.noise = options.noise;
  return problem;
}

// input.json is written last: it stands for complete files.
Status MakeInput(const JointSweepOptions& options, const JointCase& c,
                 const fs::path& folder) {
  const nlohmann::ordered_json settings = {
      {"brdf", c.brdf_path},
      {"illumination", c.map_path},
      {"geometry", IsMesh(options) ? fs::absolute(options.geometry).string()
                                   : options.geometry},
      {"width", options.size},
      {"height", options.size},
      {"quality", "reference"},
      {"samples_per_side", 2},
      {"noise", options.noise},
      {"seed", options.seed}};
  const std::string settings_path = (folder / "input.json").string();
  const std::string text = settings.dump(2) + "\n";
  if (fs::exists(settings_path)) {
    const StatusOr<std::string> present =
        ReadFile(settings_path, kMaxJsonBytes);
    if (present.ok() && *present == text) return OkStatus();
    fs::remove(settings_path);
  }
  RenderSceneOptions render;
  render.seed = options.seed;
  render.num_threads = options.num_threads;
  render.progress = [&](double) {
    return options.stop == nullptr || !*options.stop;
  };
  const StatusOr<RenderedScene> scene =
      RenderScene(RenderProblem(options, c), render);
  if (!scene.ok()) return scene.status();
  IBRDF_RETURN_IF_ERROR(
      WriteImage(scene->image, (folder / "input.exr").string()));
  Rgb8Image mask(options.size, options.size);
  for (size_t i = 0; i < mask.rgb.size(); ++i) {
    mask.rgb[i] = scene->mask.inside[i / 3] != 0 ? 255 : 0;
  }
  IBRDF_RETURN_IF_ERROR(WritePng(mask, (folder / "mask.png").string()));
  return WriteFileAtomically(settings_path, text);
}

Status WriteProblem(const JointSweepOptions& options, const JointCase& c,
                    const std::string& path) {
  const std::string geometry =
      IsMesh(options)
          ? "{mesh: " + Quoted(fs::absolute(options.geometry).string()) +
                ", fit: unit_sphere}"
          : "{sphere: {}}";
  const std::string text =
      "problem: joint\n"
      "image: {file: input.exr, mask: mask.png}\n"
      "geometry: " +
      geometry +
      "\n"
      "reflectance: {lobes: " +
      std::to_string(options.lobes) +
      "}\n"
      "illumination: {width: " +
      std::to_string(kMapWidth) + ", height: " + std::to_string(kMapHeight) +
      "}\n"
      "solver: {method: " +
      options.method + ", seconds: " + NumberCell(options.solver_seconds) +
      "}\n"
      "truth: {brdf: " +
      Quoted(c.brdf_path) + ", illumination: " + Quoted(c.map_path) + "}\n";
  return WriteFileAtomically(path, text);
}

std::string DescribeEnd(const ChildResult& child) {
  if (child.signal != 0) return "signal_" + std::to_string(child.signal);
  switch (child.exit_code) {
    case 0:
      return "ok";
    case 1:
      return "internal_error";
    case 2:
      return "bad_input";
    case 3:
      return "no_improvement";
    case 127:
      return "not_executable";
    default:
      return "exit_" + std::to_string(child.exit_code);
  }
}

// False where result.json has no metrics.
bool ReadMetrics(const std::string& path, NamedRow* row) {
  const StatusOr<std::string> text = ReadFile(path, kMaxJsonBytes);
  if (!text.ok()) return false;
  const nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("metrics") ||
      !json["metrics"].is_object()) {
    return false;
  }
  for (const char* name :
       {"misfit", "brdf_log_rmse", "brdf_log_rmse_aligned",
        "brdf_log_rmse_below80", "illumination_relative_log_rmse",
        "illumination_relative_log_rmse_aligned"}) {
    const auto value = json["metrics"].find(name);
    if (value != json["metrics"].end() && value->is_number()) {
      row->Set(name, NumberCell(value->get<double>()));
    }
  }
  return true;
}

// The input as the solver gets it, the true map at the solver's size.
Status RunBaselines(const JointSweepOptions& options, const JointCase& c,
                    const fs::path& folder, NamedRow* row) {
  const Problem problem = RenderProblem(options, c);
  const StatusOr<Image> image = ReadImage((folder / "input.exr").string());
  if (!image.ok()) return image.status();
  const StatusOr<Mask> mask = ReadMask((folder / "mask.png").string());
  if (!mask.ok()) return mask.status();
  const StatusOr<Image> full = LoadKnownIllumination(problem.illumination);
  if (!full.ok()) return full.status();
  const Image map = ResizeMap(*full, kMapHeight, kMapWidth);
  const StatusOr<IlluminationMetrics> constant = ScoreConstantMap(map);
  if (!constant.ok()) return constant.status();
  row->Set("constant_map_relative_log_rmse",
           NumberCell(constant->relative_log_rmse));
  row->Set("constant_map_relative_log_rmse_aligned",
           NumberCell(constant->relative_log_rmse_aligned));

  const StatusOr<Scene> scene = LoadScene(problem.geometry);
  if (!scene.ok()) return scene.status();
  const StatusOr<std::vector<ShadingPoint>> points = FindShadingPoints(
      *scene, problem.camera, image->width, image->height, *mask, 1);
  if (!points.ok()) return points.status();
  // Eight parameters do not need every pixel: every other row and column.
  std::vector<ShadingPoint> thin;
  for (const ShadingPoint& p : *points) {
    const bool kept =
        p.pixel % image->width % 2 == 0 && p.pixel / image->width % 2 == 0;
    if (kept || points->size() < 2000) thin.push_back(p);
  }
  CookTorranceFitOptions fit_options;
  fit_options.num_threads = options.num_threads;
  const StatusOr<CookTorranceFit> fit =
      FitCookTorrance(thin, *image, map, fit_options);
  if (!fit.ok()) return fit.status();
  const StatusOr<MerlTable> truth = ReadMerl(c.brdf_path);
  if (!truth.ok()) return truth.status();
  const StatusOr<BrdfMetrics> brdf =
      CompareBrdfs(SampleMerl(fit->brdf.Function()), *truth);
  if (!brdf.ok()) return brdf.status();
  row->Set("cook_torrance_misfit", NumberCell(fit->misfit));
  row->Set("cook_torrance_brdf_log_rmse", NumberCell(brdf->log_rmse));
  row->Set("cook_torrance_brdf_log_rmse_aligned",
           NumberCell(brdf->log_rmse_aligned));
  return OkStatus();
}

NamedRow KeyOf(const JointSweepOptions& options, const JointCase& c) {
  NamedRow row(JointColumns());
  row.Set("material", c.material);
  row.Set("map", c.map);
  row.Set("geometry", GeometryName(options));
  row.Set("lobes", std::to_string(options.lobes));
  row.Set("method", options.method);
  return row;
}

Status RunCase(const JointSweepOptions& options, const JointCase& c,
               const std::string& results) {
  const fs::path folder =
      fs::absolute(fs::path(options.out) / "cases" / c.name);
  const fs::path estimate =
      folder /
      ("estimate_" + std::to_string(options.lobes) + "_" + options.method);
  std::error_code error;
  fs::create_directories(estimate, error);
  if (error) return InvalidInput(estimate.string(), error.message());
  // A result left by a run that was cut off is not this run's.
  fs::remove(estimate / "result.json", error);
  IBRDF_RETURN_IF_ERROR(MakeInput(options, c, folder));
  const std::string problem = (folder / "joint.yaml").string();
  IBRDF_RETURN_IF_ERROR(WriteProblem(options, c, problem));

  const StatusOr<ChildResult> child = RunChild(
      {options.solver_program, "--problem", problem, "--out", estimate.string(),
       "--threads", std::to_string(options.num_threads), "--seed",
       std::to_string(options.seed), "--quiet"},
      (estimate / "solver.log").string(), options.stop);
  if (!child.ok()) return child.status();
  if (child->exit_code == 130 || (options.stop != nullptr && *options.stop)) {
    return Status(StatusCode::kInterrupted, c.name + ": interrupted");
  }
  NamedRow row = KeyOf(options, c);
  row.Set("seconds", NumberCell(child->seconds));
  row.Set("peak_mb", NumberCell(child->peak_mb));
  std::string status = DescribeEnd(*child);
  const bool finished =
      child->signal == 0 && (child->exit_code == 0 || child->exit_code == 3);
  if (finished && !ReadMetrics((estimate / "result.json").string(), &row)) {
    status = "no_result";
  }
  row.Set("status", status);
  const Status baselines = RunBaselines(options, c, folder, &row);
  if (!baselines.ok()) {
    LOG(WARNING) << c.name << ": baselines: " << baselines.message();
  }
  return AppendResult(results, JointColumns(), row.cells());
}

}  // namespace

const std::vector<std::string>& JointColumns() {
  static const std::vector<std::string> columns = {
      "material",
      "map",
      "geometry",
      "lobes",
      "method",
      "seconds",
      "peak_mb",
      "misfit",
      "brdf_log_rmse",
      "brdf_log_rmse_aligned",
      "brdf_log_rmse_below80",
      "illumination_relative_log_rmse",
      "illumination_relative_log_rmse_aligned",
      "status",
      "cook_torrance_misfit",
      "cook_torrance_brdf_log_rmse",
      "cook_torrance_brdf_log_rmse_aligned",
      "constant_map_relative_log_rmse",
      "constant_map_relative_log_rmse_aligned"};
  return columns;
}

StatusOr<std::vector<JointCase>> ListJointCases(
    const JointSweepOptions& options) {
  const std::vector<std::string> map_extensions = {".hdr", ".exr"};
  std::vector<std::string> materials = options.materials;
  std::vector<std::string> map_names = options.map_names;
  if (materials.empty()) {
    StatusOr<std::vector<std::string>> all =
        ListNames(options.data, {".binary"});
    if (!all.ok()) return all.status();
    materials = *std::move(all);
  }
  if (map_names.empty()) {
    StatusOr<std::vector<std::string>> all =
        ListNames(options.maps, map_extensions);
    if (!all.ok()) return all.status();
    map_names = *std::move(all);
  }
  std::vector<JointCase> cases;
  int index = 0;
  for (const std::string& material : materials) {
    for (const std::string& map : map_names) {
      JointCase c;
      c.material = material;
      c.map = map;
      c.name = material + "_" + map;
      if (IsMesh(options)) c.name += "_" + GeometryName(options);
      IBRDF_RETURN_IF_ERROR(CheckCaseName(c.name));
      c.brdf_path = FindFile(options.data, material, {".binary"});
      c.map_path = FindFile(options.maps, map, map_extensions);
      if (c.brdf_path.empty()) {
        return InvalidInput(options.data,
                            "expected a file " + material + ".binary");
      }
      if (c.map_path.empty()) {
        return InvalidInput(options.maps,
                            "expected a file " + map + ".hdr or .exr");
      }
      if (index++ % options.only_count == options.only_index - 1) {
        cases.push_back(c);
      }
    }
  }
  if (cases.empty()) {
    return InvalidInput("command line", "expected at least one case");
  }
  return cases;
}

Status RunJointSweep(const JointSweepOptions& options) {
  const StatusOr<std::vector<JointCase>> cases = ListJointCases(options);
  if (!cases.ok()) return cases.status();
  if (!fs::is_regular_file(options.solver_program)) {
    return InvalidInput(options.solver_program,
                        "expected the program of the "
                        "solver (--solver-program)");
  }
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) return InvalidInput(options.out, error.message());
  const std::string results = options.out + "/results.csv";
  const StatusOr<std::vector<ResultsRow>> present =
      ReadResults(results, JointColumns());
  if (!present.ok()) return present.status();
  for (size_t i = 0; i < cases->size(); ++i) {
    const JointCase& c = (*cases)[i];
    const bool done =
        HoldsCase(*present, KeyOf(options, c).cells(), kJointKeyColumns);
    if (options.report) {
      options.report("case " + std::to_string(i + 1) + " / " +
                     std::to_string(cases->size()) + "  " + c.name +
                     (done ? "  (in results.csv)" : ""));
    }
    if (!done) IBRDF_RETURN_IF_ERROR(RunCase(options, c, results));
  }
  const StatusOr<std::vector<ResultsRow>> rows =
      ReadResults(results, JointColumns());
  if (!rows.ok()) return rows.status();
  return WriteFileAtomically(
      options.out + "/results.md",
      ResultsMarkdown("# Joint estimation\n\n    " + options.command + "\n",
                      JointColumns(), *rows));
}

}  // namespace ibrdf
