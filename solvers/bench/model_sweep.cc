#include "ibrdf/solvers/bench/model_sweep.h"

namespace ibrdf {

std::vector<std::string> ModelSweepColumns(
    const std::vector<std::string>& rest) {
  std::vector<std::string> columns = {"material", "map",    "geometry",
                                      "lobes",    "method", "model"};
  columns.insert(columns.end(), rest.begin(), rest.end());
  return columns;
}

Status ForEachModelCase(
    const ModelSweepOptions& options,
    const std::function<void(const SweepCase& c, const ChosenModel& model)>&
        add) {
  const StatusOr<std::vector<SweepCase>> cases = ListSweepCases(options);
  if (!cases.ok()) return cases.status();
  const StatusOr<HeldOutModels> models = HeldOutModels::Open(options);
  if (!models.ok()) return models.status();
  for (const SweepCase& c : *cases) {
    const StatusOr<ChosenModel> model = models->For(c.material);
    if (!model.ok()) return model.status();
    add(c, *model);
  }
  return OkStatus();
}

SolverRun ModelRun(const ModelSweepOptions& options, const SweepCase& c,
                   const ChosenModel& model, const std::string& name,
                   const std::string& problem, const std::string& estimate,
                   const std::vector<std::string>& columns) {
  const std::string lobes = std::to_string(options.lobes);
  NamedRow row = CaseRow(options, c, columns);
  row.Set("lobes", lobes);
  row.Set("method", options.method);
  row.Set("model", model.label);
  return {c, name + ".yaml", problem,
          estimate + "_" + lobes + "_" + options.method + model.folder_suffix(),
          row};
}

}  // namespace ibrdf
