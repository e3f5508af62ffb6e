#include "ibrdf/solvers/bench/joint_sweep.h"

#include "ibrdf/solvers/bench/joint_baselines.h"
#include "ibrdf/solvers/bench/sphere_columns.h"

namespace ibrdf {
namespace {

std::string ProblemText(const JointSweepOptions& options, const SweepCase& c,
                        const ChosenModel& model, const std::string& prior) {
  return "problem: joint\n" + ImageYaml(options) +
         "reflectance: " + ReflectanceYaml(model, options.lobes) +
         "illumination: {width: " + std::to_string(kSweepMapWidth) +
         ", height: " + std::to_string(kSweepMapHeight) + ", prior: " + prior +
         "}\n" + SolverYaml(options) + JointTruthYaml(c);
}

}  // namespace

const std::vector<std::string>& JointColumns() {
  static const std::vector<std::string> columns =
      ModelSweepColumns({"prior",
                         "seconds",
                         "cpu_seconds",
                         "peak_mb",
                         "misfit",
                         "brdf_log_rmse",
                         "brdf_log_rmse_aligned",
                         "brdf_log_rmse_below80",
                         "brdf_log_rmse_aligned_below80",
                         "brdf_log_rmse_expected",
                         "brdf_log_rmse_90",
                         "illumination_relative_log_rmse",
                         "illumination_relative_log_rmse_aligned",
                         "status",
                         "cook_torrance_misfit",
                         "cook_torrance_brdf_log_rmse",
                         "cook_torrance_brdf_log_rmse_aligned",
                         "cook_torrance_brdf_log_rmse_aligned_below80",
                         "constant_map_relative_log_rmse",
                         "constant_map_relative_log_rmse_aligned",
                         "mirror_log_rmse",
                         "mirror_rmse",
                         "mirror_dssim",
                         "relit_log_rmse",
                         "relit_rmse",
                         "relit_dssim"});
  return columns;
}

StatusOr<SolverSweep> JointSweep(const JointSweepOptions& options) {
  SolverSweep sweep;
  sweep.title = "Joint estimation";
  sweep.columns = &JointColumns();
  sweep.key_columns = kModelSweepKeys + 1;
  IBRDF_RETURN_IF_ERROR(ForEachModelCase(
      options, [&](const SweepCase& c, const ChosenModel& model) {
        for (const std::string& prior : options.priors) {
          sweep.runs.push_back(ModelRun(options, c, model, "joint_" + prior,
                                        ProblemText(options, c, model, prior),
                                        "estimate_" + prior, *sweep.columns));
          sweep.runs.back().row.Set("prior", prior);
        }
      }));
  sweep.finish = [options](const SolverRun& run, const std::string& folder,
                           bool solved, NamedRow* row) {
    IBRDF_RETURN_IF_ERROR(SetJointBaselines(options, run.of, row));
    if (!solved) return OkStatus();
    IBRDF_RETURN_IF_ERROR(SetMirror(options, run, folder, row));
    return SetRelit(options, run, folder, row);
  };
  return sweep;
}

}  // namespace ibrdf
