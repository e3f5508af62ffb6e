#include "ibrdf/solvers/bench/pareto_sweep.h"

#include <algorithm>
#include <optional>

#include "ibrdf/base/format.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/metrics/illumination_metrics.h"
#include "ibrdf/solvers/bench/pareto_settings.h"
#include "ibrdf/solvers/bench/solver_trace.h"

namespace ibrdf {
namespace {

constexpr char kDefaultSetting[] = "default";
constexpr char kReference[] = "adam";
constexpr int kParetoKeys = 17;

struct NamedPoint {
  std::string name;
  ParetoPoint point;
};

StatusOr<std::vector<NamedPoint>> ChoosePoints(
    const ParetoSweepOptions& options) {
  ParetoPoint base;
  base.method = options.method;
  base.seconds = options.solver_seconds;
  base.size = options.size;
  base.map_width = kSweepMapWidth;
  base.lobes = options.lobes;
  const std::vector<std::string>& names = options.settings;
  const auto wanted = [&](const std::string& name) {
    return names.empty() ||
           std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<NamedPoint> points;
  size_t known = 0;
  for (const ParetoSetting& setting : ParetoSettings()) {
    if (!wanted(setting.name)) continue;
    known += std::count(names.begin(), names.end(), setting.name);
    ParetoPoint point = base;
    setting.change(&point);
    const bool again =
        !points.empty() && wanted(kDefaultSetting) && point == base;
    if (!again) points.push_back({setting.name, point});
  }
  if (known == names.size()) return points;
  for (const std::string& name : names) {
    const auto& all = ParetoSettings();
    if (std::none_of(all.begin(), all.end(),
                     [&](const auto& s) { return name == s.name; })) {
      return InvalidInput("command line: --settings",
                          name + ": expected some of " + ParetoSettingNames());
    }
  }
  return points;
}

std::string ProblemText(const ParetoSweepOptions& options, const SweepCase& c,
                        const ChosenModel& model, const ParetoPoint& p) {
  return "problem: joint\n" + ImageYaml(options) +
         "reflectance: " + ReflectanceYaml(model, p.lobes, p.models == 1) +
         "illumination: {width: " + std::to_string(p.map_width) +
         ", height: " + std::to_string(p.map_width / 2) +
         ", prior: " + p.prior +
         (p.prior == "unet"
              ? ", unet_channels: " + std::to_string(p.unet_channels)
              : "") +
         "}\nsolver: {estimator: " + p.estimator + ", method: " + p.method +
         ", quadrature: " + p.quadrature + ", search: " + p.search +
         ", turns: " + std::to_string(p.turns) +
         ", seconds: " + NumberCell(p.seconds) +
         ", tolerance: " + NumberCell(p.tolerance) +
         ", max_iterations: " + std::to_string(p.max_iterations) + "}\n" +
         JointTruthYaml(c);
}

// A folder of its own for each setting under any options: no results are
// overwritten.
std::string EstimateName(const NamedPoint& named, const ChosenModel& model) {
  const ParetoPoint& p = named.point;
  return "pareto_" + named.name + "_" + p.estimator + "_" + p.method + "_" +
         NumberCell(p.seconds) + "s_" + std::to_string(p.map_width) + "_" +
         std::to_string(p.lobes) + "_" + p.prior +
         std::to_string(p.unet_channels) + "_" + p.quadrature + "_" +
         p.search + std::to_string(p.turns) + "_" + std::to_string(p.models) +
         model.folder_suffix();
}

NamedRow KeyRow(const ParetoSweepOptions& options, const SweepCase& c,
                const ChosenModel& model, const NamedPoint& named) {
  const ParetoPoint& p = named.point;
  NamedRow row = CaseRow(options, c, ParetoColumns());
  row.Set("setting", named.name);
  row.Set("model", model.label);
  row.Set("estimator", p.estimator);
  row.Set("method", p.method);
  row.Set("budget_seconds", NumberCell(p.seconds));
  row.Set("size", std::to_string(p.size));
  row.Set("map_width", std::to_string(p.map_width));
  row.Set("lobes", std::to_string(p.lobes));
  row.Set("prior", p.prior);
  row.Set("unet_channels",
          p.prior == "unet" ? std::to_string(p.unet_channels) : "");
  row.Set("quadrature", p.quadrature);
  row.Set("search", p.search);
  row.Set("turns", std::to_string(p.turns));
  row.Set("models", std::to_string(p.models));
  return row;
}

std::string EstimateFile(const SweepOptions& options, const SolverRun& run,
                         const std::string& file) {
  return CaseFolder(options, run.of) + "/" + run.estimate + "/" + file;
}

// Rounds, and the error of a map that is not of the size of the others.
Status Finish(const ParetoSweepOptions& options, const SolverRun& run,
              bool solved, NamedRow* row) {
  if (!solved) return OkStatus();
  const StatusOr<std::vector<TraceLine>> trace =
      ReadTrace(EstimateFile(options, run, "result.json"));
  if (!trace.ok()) return trace.status();
  row->Set("rounds", std::to_string(CountIterations(*trace)));
  const StatusOr<Image> map =
      ReadMap(EstimateFile(options, run, "illumination.exr"), std::nullopt);
  if (!map.ok()) return map.status();
  if (map->width == kSweepMapWidth) return OkStatus();
  const StatusOr<Image> truth = TrueMap(options, run.of);
  if (!truth.ok()) return truth.status();
  const StatusOr<IlluminationMetrics> metrics = CompareIlluminations(
      ResizeMap(*map, kSweepMapHeight, kSweepMapWidth), *truth);
  if (!metrics.ok()) return metrics.status();
  row->Set("illumination_relative_log_rmse",
           NumberCell(metrics->relative_log_rmse));
  row->Set("illumination_relative_log_rmse_aligned",
           NumberCell(metrics->relative_log_rmse_aligned));
  return OkStatus();
}

std::string Cells(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

// How long the default takes to the reference's last misfit, both on pixels of
// like normals joined.
std::string MisfitTimeTable(const ParetoSweepOptions& options,
                            const std::vector<SolverRun>& defaults,
                            const std::vector<SolverRun>& references) {
  std::string lines;
  for (const SolverRun& reference : references) {
    const auto of_case = std::find_if(
        defaults.begin(), defaults.end(),
        [&](const SolverRun& run) { return run.of.name == reference.of.name; });
    if (of_case == defaults.end()) continue;
    const auto slow =
        ReadTrace(EstimateFile(options, reference, "result.json"));
    const auto fast = ReadTrace(EstimateFile(options, *of_case, "result.json"));
    if (!slow.ok() || !fast.ok()) continue;
    const TraceLine* const last = LastIteration(*slow);
    if (last == nullptr) continue;
    const double schedule = slow->back().seconds;
    const std::optional<double> at = SecondsToMisfit(*fast, *last);
    lines += Cells({reference.of.material, reference.of.map,
                    std::to_string(CountIterations(*slow)),
                    Format("%.4f", last->misfit), Format("%.1f", last->seconds),
                    Format("%.1f", schedule),
                    at.has_value() ? Format("%.1f", *at) : "not reached",
                    at.has_value() ? Format("%.1f", schedule / *at) : "",
                    Format("%.1f", fast->back().seconds)});
  }
  if (lines.empty()) return "";
  return "## Time to Adam's last misfit\n\n" +
         Cells({"material", "map", "Adam: rounds that gained",
                "last misfit, joined pixels", "seconds to it",
                "of the schedule", "default: seconds to that misfit",
                "schedule over that", "default: seconds"}) +
         "|---|---|---|---|---|---|---|---|---|\n" + lines;
}

}  // namespace

std::string ParetoSettingNames() {
  std::string names;
  for (const ParetoSetting& setting : ParetoSettings()) {
    names += (names.empty() ? "" : ", ") + std::string(setting.name);
  }
  return names;
}

const std::vector<std::string>& ParetoColumns() {
  static const std::vector<std::string> columns = {
      "material",
      "map",
      "geometry",
      "setting",
      "model",
      "estimator",
      "method",
      "budget_seconds",
      "size",
      "map_width",
      "lobes",
      "prior",
      "unet_channels",
      "quadrature",
      "search",
      "turns",
      "models",
      "seconds",
      "cpu_seconds",
      "peak_mb",
      "misfit",
      "brdf_log_rmse",
      "brdf_log_rmse_aligned",
      "brdf_log_rmse_below80",
      "illumination_relative_log_rmse",
      "illumination_relative_log_rmse_aligned",
      "rounds",
      "status"};
  return columns;
}

StatusOr<SolverSweep> ParetoSweep(const ParetoSweepOptions& options) {
  const StatusOr<std::vector<NamedPoint>> points = ChoosePoints(options);
  if (!points.ok()) return points.status();
  SolverSweep sweep;
  sweep.title = "What accuracy costs in time";
  sweep.columns = &ParetoColumns();
  sweep.key_columns = kParetoKeys;
  std::vector<SolverRun> defaults, references;
  IBRDF_RETURN_IF_ERROR(ForEachModelCase(
      options, [&](const SweepCase& c, const ChosenModel& model) {
        for (const NamedPoint& named : *points) {
          const int size = named.point.size;
          const SweepCase of = size == c.size ? c : CaseOfSize(c, size);
          const SolverRun run = {of, "pareto_" + named.name + ".yaml",
                                 ProblemText(options, c, model, named.point),
                                 EstimateName(named, model),
                                 KeyRow(options, c, model, named)};
          sweep.runs.push_back(run);
          if (named.name == kDefaultSetting) defaults.push_back(run);
          if (named.name == kReference) references.push_back(run);
        }
      }));
  sweep.finish = [options](const SolverRun& run, const std::string&,
                           bool solved, NamedRow* row) {
    return Finish(options, run, solved, row);
  };
  sweep.summary = [options, defaults, references] {
    return MisfitTimeTable(options, defaults, references);
  };
  return sweep;
}

}  // namespace ibrdf
