#include "ibrdf/solvers/bench/solver_sweep.h"

#include <glog/logging.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/baselines/cook_torrance_fit.h"
#include "ibrdf/solvers/bench/child_process.h"
#include "ibrdf/solvers/bench/sweep_files.h"
#include "ibrdf/solvers/bench/sweep_inputs.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "ibrdf/solvers/problem/load_scene.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;  // exit status

std::string DescribeEnd(const ChildResult& child) {
  if (child.signal != 0) return "signal_" + std::to_string(child.signal);
  switch (child.exit_code) {
    case 0:
      return "ok";
    case 1:
      return "internal_error";
    case kBadInput:
      return "bad_input";
    case 3:
      return "no_improvement";
    case 127:
      return "not_executable";
    default:
      return "exit_" + std::to_string(child.exit_code);
  }
}

// Sets the columns that an object of result.json names.
void SetNumbers(const nlohmann::json& values,
                const std::vector<std::string>& names,
                const std::vector<std::string>& columns, NamedRow* row) {
  for (const std::string& name : names) {
    const bool wanted =
        std::find(columns.begin(), columns.end(), name) != columns.end();
    const auto value = values.find(name);
    if (wanted && value != values.end() && value->is_number()) {
      row->Set(name, NumberCell(value->get<double>()));
    }
  }
}

// False where result.json has no metrics.
bool ReadMetrics(const std::string& path,
                 const std::vector<std::string>& columns, NamedRow* row) {
  const StatusOr<std::string> text = ReadFile(path, kMaxResultBytes);
  if (!text.ok()) return false;
  const nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("metrics") ||
      !json["metrics"].is_object()) {
    return false;
  }
  SetNumbers(json["metrics"],
             {"misfit", "brdf_log_rmse", "brdf_log_rmse_aligned",
              "brdf_log_rmse_below80", "brdf_log_rmse_aligned_below80",
              "illumination_relative_log_rmse",
              "illumination_relative_log_rmse_aligned"},
             columns, row);
  const auto posterior = json.find("posterior");
  if (posterior != json.end() && posterior->is_object()) {
    SetNumbers(*posterior, {"brdf_log_rmse_expected", "brdf_log_rmse_90"},
               columns, row);
  }
  return true;
}

// The last line of a solver's log without "error: "; empty where it is empty.
std::string LastWords(const std::string& log) {
  const StatusOr<std::string> text = ReadFile(log, kMaxResultBytes);
  if (!text.ok()) return "";
  const size_t last = text->find_last_not_of('\n');
  if (last == std::string::npos) return "";
  const size_t before = text->rfind('\n', last);
  const size_t begin = before == std::string::npos ? 0 : before + 1;
  const std::string line = text->substr(begin, last + 1 - begin);
  const std::string mark = "error: ";
  return line.compare(0, mark.size(), mark) == 0 ? line.substr(mark.size())
                                                 : line;
}

// Whether "PATH: what" is no property of the case: PATH was there when the
// sweep began and is gone, or it lies in `folder` and could not be written.
bool FromOutside(const std::string& message, const fs::path& folder) {
  const std::string path = message.substr(0, message.find(": "));
  if (path.empty() || path[0] != '/') return false;
  std::error_code error;
  return !fs::exists(path, error) || path.rfind(folder.string() + "/", 0) == 0;
}

Status WithoutRow(const SolverRun& run, const std::string& message) {
  return Status(StatusCode::kInvalidInput,
                message + "; " + run.of.name + " " + run.estimate +
                    " has no row, the same command goes on there");
}

// What all rows of a table share and none of them says; text.
std::map<std::string, std::string> SharedSettings(
    const SolverSweepOptions& options, const SolverSweep& sweep) {
  std::map<std::string, std::string> settings = {
      {"budget_seconds", NumberCell(options.solver_seconds)},
      {"method", options.method},
      {"noise", NumberCell(options.noise)},
      {"seed", std::to_string(options.seed)},
      {"size", std::to_string(options.size)}};
  const auto keys_end = sweep.columns->begin() + sweep.key_columns;
  for (auto s = settings.begin(); s != settings.end();) {
    const bool said =
        std::find(sweep.columns->begin(), keys_end, s->first) != keys_end;
    s = said ? settings.erase(s) : std::next(s);
  }
  return settings;
}

// Whether the rows that are there, or that others write, have these settings;
// the first run writes them down.
Status CheckSettings(const SolverSweepOptions& options,
                     const SolverSweep& sweep) {
  const std::string path = options.out + "/settings.json";
  const std::map<std::string, std::string> settings =
      SharedSettings(options, sweep);
  if (!fs::exists(path)) {
    return WriteFileAtomically(path, nlohmann::json(settings).dump(2) + "\n");
  }
  const StatusOr<std::string> text = ReadFile(path, kMaxResultBytes);
  if (!text.ok()) return text.status();
  const nlohmann::json begun = nlohmann::json::parse(*text, nullptr, false);
  for (const auto& [name, value] : settings) {
    const bool there =
        begun.is_object() && begun.contains(name) && begun[name].is_string();
    const std::string before =
        there ? begun[name].get<std::string>() : "nothing";
    if (before == value) continue;
    return InvalidInput(path + ": " + name,
                        "the sweep was begun with " + before + ", found " +
                            value + "; expected the same or another --out");
  }
  return OkStatus();
}

// Where a run reads and writes.
struct RunFiles {
  fs::path folder, estimate;
  std::string problem, log, result;
};

// Makes the folder and writes the problem file.
StatusOr<RunFiles> PrepareRun(const SolverSweepOptions& options,
                              const SolverRun& run) {
  RunFiles files;
  files.folder = CaseFolder(options, run.of);
  files.estimate = files.folder / run.estimate;
  files.problem = (files.folder / run.problem_name).string();
  files.log = (files.estimate / "solver.log").string();
  files.result = (files.estimate / "result.json").string();
  std::error_code error;
  fs::create_directories(files.estimate, error);
  if (error) return InvalidInput(files.estimate.string(), error.message());
  // A result left by a run that was cut off is not this run's.
  fs::remove(files.result, error);
  if (run.prepare) IBRDF_RETURN_IF_ERROR(run.prepare(files.folder.string()));
  IBRDF_RETURN_IF_ERROR(WriteFileAtomically(files.problem, run.problem));
  return files;
}

// Fails where the run is to have no row: it was interrupted, or what ended it
// is no property of the case.
StatusOr<ChildResult> RunSolver(const SolverSweepOptions& options,
                                const SolverRun& run, const RunFiles& files) {
  StatusOr<ChildResult> child =
      RunChild({options.solver_program, "--problem", files.problem, "--out",
                files.estimate.string(), "--threads",
                std::to_string(options.num_threads), "--seed",
                std::to_string(options.seed), "--quiet"},
               files.log, options.stop);
  if (!child.ok()) return child.status();
  if (child->exit_code == 130 || options.stopped()) {
    return Status(StatusCode::kInterrupted, run.of.name + ": interrupted");
  }
  if (child->signal == 0 && child->exit_code == kBadInput) {
    // Who refuses says why: an empty log is one that had no room on the disk.
    const std::string words = LastWords(files.log);
    if (words.empty()) {
      return WithoutRow(run, files.log + ": cannot be written");
    }
    if (FromOutside(words, files.estimate)) return WithoutRow(run, words);
  }
  return child;
}

// Sets what the solver's end and its result tell. Returns whether it left an
// estimate.
bool SetOutcome(const SolverSweep& sweep, const ChildResult& child,
                const RunFiles& files, NamedRow* row) {
  row->Set("seconds", NumberCell(child.seconds));
  row->Set("cpu_seconds", NumberCell(child.cpu_seconds));
  row->Set("peak_mb", NumberCell(child.peak_mb));
  const bool ended =
      child.signal == 0 && (child.exit_code == 0 || child.exit_code == 3);
  const bool solved = ended && ReadMetrics(files.result, *sweep.columns, row);
  row->Set("status", ended && !solved ? "no_result" : DescribeEnd(child));
  return solved;
}

Status RunOne(const SolverSweepOptions& options, const SolverSweep& sweep,
              const SolverRun& run, const std::string& results) {
  const StatusOr<RunFiles> files = PrepareRun(options, run);
  if (!files.ok()) return files.status();
  const StatusOr<ChildResult> child = RunSolver(options, run, *files);
  if (!child.ok()) return child.status();
  NamedRow row = run.row;
  const bool solved = SetOutcome(sweep, *child, *files, &row);
  if (sweep.finish) {
    const std::string folder = files->folder.string();
    const Status finished = sweep.finish(run, folder, solved, &row);
    if (!finished.ok()) {
      if (FromOutside(finished.message(), files->folder)) {
        return WithoutRow(run, finished.message());
      }
      LOG(WARNING) << run.of.name << ": " << finished.message();
    }
  }
  return AppendResult(results, *sweep.columns, row.cells());
}

}  // namespace

NamedRow CaseRow(const SweepOptions& options, const SweepCase& c,
                 const std::vector<std::string>& columns) {
  NamedRow row(columns);
  row.Set("material", c.material);
  row.Set("map", c.map);
  row.Set("geometry", GeometryName(options));
  return row;
}

std::string SolverYaml(const SolverSweepOptions& options) {
  return "solver: {method: " + options.method +
         ", seconds: " + NumberCell(options.solver_seconds) + "}\n";
}

std::string JointTruthYaml(const SweepCase& c) {
  return "truth: {brdf: " + Quoted(c.brdf_path) +
         ", illumination: " + MapAndFrame(c) + "}\n";
}

StatusOr<Image> TrueMap(const SweepOptions& options, const SweepCase& c) {
  const StatusOr<Image> full =
      LoadKnownIllumination(RenderProblem(options, c).illumination);
  if (!full.ok()) return full.status();
  return ResizeMap(*full, kSweepMapHeight, kSweepMapWidth);
}

Status SetConstantMap(const Image& truth, NamedRow* row) {
  const StatusOr<IlluminationMetrics> constant = ScoreConstantMap(truth);
  if (!constant.ok()) return constant.status();
  row->Set("constant_map_relative_log_rmse",
           NumberCell(constant->relative_log_rmse));
  row->Set("constant_map_relative_log_rmse_aligned",
           NumberCell(constant->relative_log_rmse_aligned));
  return OkStatus();
}

Status SolverSweepOptions::Check() const {
  if (fs::is_regular_file(solver_program)) return OkStatus();
  return InvalidInput(solver_program,
                      "expected the program of the solver (--solver-program)");
}

Status RunSolverSweep(const SolverSweepOptions& options,
                      const SolverSweep& sweep) {
  IBRDF_RETURN_IF_ERROR(options.Check());
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) return InvalidInput(options.out, error.message());
  IBRDF_RETURN_IF_ERROR(CheckSettings(options, sweep));
  const std::string results = options.out + "/results.csv";
  const StatusOr<std::vector<ResultsRow>> present =
      ReadResults(results, *sweep.columns);
  if (!present.ok()) return present.status();
  std::vector<bool> done;
  std::vector<SweepCase> open;
  std::set<std::string> listed;
  for (const SolverRun& run : sweep.runs) {
    done.push_back(HoldsCase(*present, run.row.cells(), sweep.key_columns));
    if (!done.back() && listed.insert(run.of.name).second) {
      open.push_back(run.of);
    }
  }
  IBRDF_RETURN_IF_ERROR(MakeInputs(options, open));
  for (size_t i = 0; i < sweep.runs.size(); ++i) {
    if (options.report) {
      options.report("case " + std::to_string(i + 1) + " / " +
                     std::to_string(sweep.runs.size()) + "  " +
                     sweep.runs[i].of.name + "  " + sweep.runs[i].estimate +
                     (done[i] ? "  (in results.csv)" : ""));
    }
    if (!done[i]) {
      IBRDF_RETURN_IF_ERROR(RunOne(options, sweep, sweep.runs[i], results));
    }
  }
  const StatusOr<std::vector<ResultsRow>> rows =
      ReadResults(results, *sweep.columns);
  if (!rows.ok()) return rows.status();
  return WriteFileAtomically(
      options.out + "/results.md",
      ResultsMarkdown("# " + sweep.title + "\n\n    " + options.command + "\n" +
                          (sweep.summary ? "\n" + sweep.summary() : ""),
                      *sweep.columns, *rows));
}

}  // namespace ibrdf
