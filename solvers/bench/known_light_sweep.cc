#include "solvers/bench/known_light_sweep.h"

#include <utility>

namespace ibrdf {
namespace {

constexpr int kKeyColumns = 6;

std::string ProblemText(const KnownLightSweepOptions& options,
                        const SweepCase& c, const ChosenModel& model) {
  return "problem: reflectance\n" + ImageYaml(options) +
         "reflectance: " + ReflectanceYaml(model, options.lobes) +
         "illumination: {known: " + Quoted(c.map_path) + "}\n" +
         SolverYaml(options) + "truth: {brdf: " + Quoted(c.brdf_path) + "}\n";
}

}  // namespace

const std::vector<std::string>& KnownLightColumns() {
  static const std::vector<std::string> columns = {"material",
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
                                                   "status"};
  return columns;
}

StatusOr<std::vector<SolverRun>> ListKnownLightRuns(
    const KnownLightSweepOptions& options) {
  const StatusOr<std::vector<SweepCase>> cases = ListSweepCases(options);
  if (!cases.ok()) return cases.status();
  const StatusOr<HeldOutModels> models = HeldOutModels::Open(options);
  if (!models.ok()) return models.status();
  std::vector<SolverRun> runs;
  for (const SweepCase& c : *cases) {
    const StatusOr<ChosenModel> model = models->For(c.material);
    if (!model.ok()) return model.status();
    NamedRow row(KnownLightColumns());
    row.Set("material", c.material);
    row.Set("map", c.map);
    row.Set("geometry", GeometryName(options));
    row.Set("lobes", std::to_string(options.lobes));
    row.Set("method", options.method);
    row.Set("model", model->label);
    runs.push_back({c, "known_light.yaml", ProblemText(options, c, *model),
                    "known_light_" + std::to_string(options.lobes) + "_" +
                        options.method + model->folder_suffix(),
                    row});
  }
  return runs;
}

Status RunKnownLightSweep(const KnownLightSweepOptions& options) {
  StatusOr<std::vector<SolverRun>> runs = ListKnownLightRuns(options);
  if (!runs.ok()) return runs.status();
  SolverSweep sweep;
  sweep.title = "Reflectance under known light";
  sweep.columns = &KnownLightColumns();
  sweep.key_columns = kKeyColumns;
  sweep.runs = *std::move(runs);
  return RunSolverSweep(options, sweep);
}

}  // namespace ibrdf
