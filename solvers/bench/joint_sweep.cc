#include "solvers/bench/joint_sweep.h"

#include <filesystem>

#include "ibrdf/metrics/brdf_metrics.h"
#include "io/image_file.h"
#include "io/merl.h"
#include "io/png.h"
#include "solvers/baselines/cook_torrance_fit.h"
#include "solvers/render_scene.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

constexpr int kKeyColumns = 6;

// The input as the solver gets it, the true map at the solver's size.
Status RunBaselines(const JointSweepOptions& options, const SweepCase& c,
                    const fs::path& folder, NamedRow* row) {
  const Problem problem = RenderProblem(options, c);
  const StatusOr<Image> image = ReadImage((folder / "input.exr").string());
  if (!image.ok()) return image.status();
  const StatusOr<Mask> mask = ReadMask((folder / "mask.png").string());
  if (!mask.ok()) return mask.status();
  const StatusOr<Image> map = TrueMap(options, c);
  if (!map.ok()) return map.status();
  IBRDF_RETURN_IF_ERROR(SetConstantMap(*map, row));

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
      FitCookTorrance(thin, *image, *map, fit_options);
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

std::string ProblemText(const JointSweepOptions& options, const SweepCase& c,
                        const ChosenModel& model) {
  return "problem: joint\n" + ImageYaml(options) +
         "reflectance: " + ReflectanceYaml(model, options.lobes) +
         "illumination: {width: " + std::to_string(kSweepMapWidth) +
         ", height: " + std::to_string(kSweepMapHeight) + "}\n" +
         SolverYaml(options) + "truth: {brdf: " + Quoted(c.brdf_path) +
         ", illumination: " + Quoted(c.map_path) + "}\n";
}

}  // namespace

const std::vector<std::string>& JointColumns() {
  static const std::vector<std::string> columns = {
      "material",
      "map",
      "geometry",
      "lobes",
      "method",
      "model",
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

StatusOr<std::vector<SolverRun>> ListJointRuns(
    const JointSweepOptions& options) {
  const StatusOr<std::vector<SweepCase>> cases = ListSweepCases(options);
  if (!cases.ok()) return cases.status();
  const StatusOr<HeldOutModels> models = HeldOutModels::Open(options);
  if (!models.ok()) return models.status();
  std::vector<SolverRun> runs;
  for (const SweepCase& c : *cases) {
    const StatusOr<ChosenModel> model = models->For(c.material);
    if (!model.ok()) return model.status();
    NamedRow row(JointColumns());
    row.Set("material", c.material);
    row.Set("map", c.map);
    row.Set("geometry", GeometryName(options));
    row.Set("lobes", std::to_string(options.lobes));
    row.Set("method", options.method);
    row.Set("model", model->label);
    runs.push_back({c, "joint.yaml", ProblemText(options, c, *model),
                    "estimate_" + std::to_string(options.lobes) + "_" +
                        options.method + model->folder_suffix(),
                    row});
  }
  return runs;
}

Status RunJointSweep(const JointSweepOptions& options) {
  StatusOr<std::vector<SolverRun>> runs = ListJointRuns(options);
  if (!runs.ok()) return runs.status();
  SolverSweep sweep;
  sweep.title = "Joint estimation";
  sweep.columns = &JointColumns();
  sweep.key_columns = kKeyColumns;
  sweep.runs = *std::move(runs);
  sweep.finish = [&](const SolverRun& run, const std::string& folder, bool,
                     NamedRow* row) {
    return RunBaselines(options, run.of, folder, row);
  };
  return RunSolverSweep(options, sweep);
}

}  // namespace ibrdf
