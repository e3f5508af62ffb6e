#include "ibrdf/solvers/bench/photograph_sweep.h"

#include <algorithm>

#include "ibrdf/io/image_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/bench/photograph_settings.h"

namespace ibrdf {
namespace {

std::string FileName(const PhotographSetting& setting) {
  return "photograph_" + setting.name + ExtensionOf(setting);
}

std::string ProblemText(const PhotographSweepOptions& options,
                        const SweepCase& c, const ChosenModel& model,
                        const PhotographSetting& setting) {
  std::string image = "file: " + FileName(setting) + ", mask: mask.png";
  if (!setting.response.empty()) image += ", response: " + setting.response;
  return "problem: joint\n" + ImageYaml(options, image) +
         "reflectance: " + ReflectanceYaml(model, options.lobes) +
         "illumination: {width: " + std::to_string(kSweepMapWidth) +
         ", height: " + std::to_string(kSweepMapHeight) + "}\n" +
         SolverYaml(options) + JointTruthYaml(c);
}

Status WriteInput(const PhotographSetting& setting, const std::string& folder) {
  const StatusOr<Image> radiance = ReadImage(folder + "/input.exr");
  if (!radiance.ok()) return radiance.status();
  const StatusOr<Mask> mask = ReadMask(folder + "/mask.png");
  if (!mask.ok()) return mask.status();
  return WritePhotograph(setting, *radiance, *mask,
                         folder + "/" + FileName(setting));
}

StatusOr<std::vector<PhotographSetting>> ChooseSettings(
    const std::vector<std::string>& names) {
  if (names.empty()) return PhotographSettings();
  std::vector<PhotographSetting> chosen;
  for (const std::string& name : names) {
    const auto& all = PhotographSettings();
    const auto found = std::find_if(
        all.begin(), all.end(), [&](const auto& s) { return s.name == name; });
    if (found == all.end()) {
      return InvalidInput(
          "command line: --settings",
          name + ": expected some of " + PhotographSettingNames());
    }
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace

std::string PhotographSettingNames() {
  std::string names;
  for (const PhotographSetting& setting : PhotographSettings()) {
    names += (names.empty() ? "" : ", ") + setting.name;
  }
  return names;
}

const std::vector<std::string>& PhotographColumns() {
  static const std::vector<std::string> columns = ModelSweepColumns(
      {"setting", "seconds", "cpu_seconds", "peak_mb", "misfit",
       "brdf_log_rmse", "brdf_log_rmse_aligned", "brdf_log_rmse_below80",
       "illumination_relative_log_rmse",
       "illumination_relative_log_rmse_aligned", "status"});
  return columns;
}

StatusOr<SolverSweep> PhotographSweep(const PhotographSweepOptions& options) {
  const StatusOr<std::vector<PhotographSetting>> settings =
      ChooseSettings(options.settings);
  if (!settings.ok()) return settings.status();
  SolverSweep sweep;
  sweep.title = "Joint estimation from photographs";
  sweep.columns = &PhotographColumns();
  sweep.key_columns = kModelSweepKeys + 1;
  IBRDF_RETURN_IF_ERROR(ForEachModelCase(
      options, [&](const SweepCase& c, const ChosenModel& model) {
        for (const PhotographSetting& setting : *settings) {
          const std::string name = "photograph_" + setting.name;
          SolverRun run = ModelRun(options, c, model, name,
                                   ProblemText(options, c, model, setting),
                                   name, *sweep.columns);
          run.row.Set("setting", setting.name);
          run.prepare = [setting](const std::string& folder) {
            return WriteInput(setting, folder);
          };
          sweep.runs.push_back(std::move(run));
        }
      }));
  return sweep;
}

}  // namespace ibrdf
