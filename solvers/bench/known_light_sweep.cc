#include "ibrdf/solvers/bench/known_light_sweep.h"

#include "ibrdf/solvers/bench/sphere_columns.h"

namespace ibrdf {

const std::vector<std::string>& KnownLightColumns() {
  static const std::vector<std::string> columns = ModelSweepColumns(
      {"seconds", "cpu_seconds", "peak_mb", "misfit", "brdf_log_rmse",
       "brdf_log_rmse_aligned", "brdf_log_rmse_below80",
       "brdf_log_rmse_aligned_below80", "brdf_log_rmse_expected",
       "brdf_log_rmse_90", "status", "relit_log_rmse", "relit_rmse",
       "relit_dssim"});
  return columns;
}

StatusOr<SolverSweep> KnownLightSweep(const KnownLightSweepOptions& options) {
  SolverSweep sweep;
  sweep.title = "Reflectance under known light";
  sweep.columns = &KnownLightColumns();
  sweep.key_columns = kModelSweepKeys;
  IBRDF_RETURN_IF_ERROR(ForEachModelCase(
      options, [&](const SweepCase& c, const ChosenModel& model) {
        const std::string problem =
            "problem: reflectance\n" + ImageYaml(options) +
            "reflectance: " + ReflectanceYaml(model, options.lobes) +
            "illumination: {known: " + MapAndFrame(c) + "}\n" +
            SolverYaml(options) + "truth: {brdf: " + Quoted(c.brdf_path) +
            "}\n";
        sweep.runs.push_back(ModelRun(options, c, model, "known_light", problem,
                                      "known_light", *sweep.columns));
      }));
  sweep.finish = [options](const SolverRun& run, const std::string& folder,
                           bool solved, NamedRow* row) {
    return solved ? SetRelit(options, run, folder, row) : OkStatus();
  };
  return sweep;
}

}  // namespace ibrdf
