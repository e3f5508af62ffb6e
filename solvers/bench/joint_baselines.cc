#include "ibrdf/solvers/bench/joint_baselines.h"

#include <nlohmann/json.hpp>

#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/image_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/bench/solver_sweep.h"
#include "ibrdf/solvers/bench/sweep_files.h"
#include "ibrdf/solvers/bench/sweep_inputs.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "ibrdf/solvers/problem/load_scene.h"

namespace ibrdf {
namespace {

using Json = nlohmann::ordered_json;

// Counts changes of the fit that its options do not show.
constexpr int kFitVersion = 2;

Json Made(const SweepOptions& options, const SweepCase& c,
          const CookTorranceFitOptions& fit) {
  return {{"input", Json::parse(InputSettings(options, c))},
          {"map_width", kSweepMapWidth},
          {"map_height", kSweepMapHeight},
          {"version", kFitVersion},
          {"max_points", fit.max_points},
          {"start_roughness", fit.start_roughness},
          {"start_f0", fit.start_f0},
          {"refined_starts", fit.refined_starts},
          {"refining_steps", fit.refining_steps},
          {"smoothing", fit.smoothing},
          {"max_iterations", fit.max_iterations},
          {"tolerance", fit.tolerance}};
}

// False where the file holds no score made so.
bool ReadScore(const std::string& path, const Json& made,
               CookTorranceScore* score) {
  const StatusOr<std::string> text = ReadFile(path, kMaxSettingsBytes);
  if (!text.ok()) return false;
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("made") || json["made"] != made) {
    return false;
  }
  const auto read = [&](const char* key, double* out) {
    const auto at = json.find(key);
    if (at == json.end() || !at->is_number()) return false;
    *out = at->get<double>();
    return true;
  };
  return read("misfit", &score->misfit) &&
         read("brdf_log_rmse", &score->brdf_log_rmse) &&
         read("brdf_log_rmse_aligned", &score->brdf_log_rmse_aligned) &&
         read("brdf_log_rmse_aligned_below80",
              &score->brdf_log_rmse_aligned_below80);
}

StatusOr<CookTorranceScore> Fit(const SweepOptions& options, const SweepCase& c,
                                CookTorranceFitOptions fit_options) {
  const Problem problem = RenderProblem(options, c);
  const std::string folder = CaseFolder(options, c);
  const StatusOr<Image> image = ReadImage(folder + "/input.exr");
  if (!image.ok()) return image.status();
  const StatusOr<Mask> mask = ReadMask(folder + "/mask.png");
  if (!mask.ok()) return mask.status();
  const StatusOr<Image> map = TrueMap(options, c);
  if (!map.ok()) return map.status();
  const StatusOr<Scene> scene = LoadScene(problem, image->width, image->height);
  if (!scene.ok()) return scene.status();
  const StatusOr<std::vector<ShadingPoint>> points = FindShadingPoints(
      *scene, problem.camera, image->width, image->height, *mask, 1);
  if (!points.ok()) return points.status();
  fit_options.num_threads = options.num_threads;
  const StatusOr<CookTorranceFit> fit =
      FitCookTorrance(*points, *image, *map, fit_options);
  if (!fit.ok()) return fit.status();
  const StatusOr<MerlTable> truth = ReadMerl(c.brdf_path);
  if (!truth.ok()) return truth.status();
  const StatusOr<BrdfMetrics> brdf =
      CompareBrdfs(SampleMerl(fit->brdf.Function()), *truth);
  if (!brdf.ok()) return brdf.status();
  return CookTorranceScore{fit->misfit, brdf->log_rmse, brdf->log_rmse_aligned,
                           brdf->log_rmse_aligned_below80};
}

}  // namespace

StatusOr<CookTorranceScore> ScoreCookTorrance(
    const SweepOptions& options, const SweepCase& c,
    const CookTorranceFitOptions& fit) {
  const std::string path = CaseFolder(options, c) + "/cook_torrance.json";
  const Json made = Made(options, c, fit);
  CookTorranceScore kept;
  if (ReadScore(path, made, &kept)) return kept;
  StatusOr<CookTorranceScore> score = Fit(options, c, fit);
  if (!score.ok()) return score.status();
  const Json json = {
      {"made", made},
      {"misfit", score->misfit},
      {"brdf_log_rmse", score->brdf_log_rmse},
      {"brdf_log_rmse_aligned", score->brdf_log_rmse_aligned},
      {"brdf_log_rmse_aligned_below80", score->brdf_log_rmse_aligned_below80}};
  IBRDF_RETURN_IF_ERROR(WriteFileAtomically(path, json.dump(2) + "\n"));
  return score;
}

Status SetJointBaselines(const SweepOptions& options, const SweepCase& c,
                         NamedRow* row) {
  const StatusOr<Image> map = TrueMap(options, c);
  if (!map.ok()) return map.status();
  IBRDF_RETURN_IF_ERROR(SetConstantMap(*map, row));
  const StatusOr<CookTorranceScore> score = ScoreCookTorrance(options, c);
  if (!score.ok()) return score.status();
  row->Set("cook_torrance_misfit", NumberCell(score->misfit));
  row->Set("cook_torrance_brdf_log_rmse", NumberCell(score->brdf_log_rmse));
  row->Set("cook_torrance_brdf_log_rmse_aligned",
           NumberCell(score->brdf_log_rmse_aligned));
  row->Set("cook_torrance_brdf_log_rmse_aligned_below80",
           NumberCell(score->brdf_log_rmse_aligned_below80));
  return OkStatus();
}

}  // namespace ibrdf
