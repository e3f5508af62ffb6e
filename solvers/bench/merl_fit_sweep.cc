#include "ibrdf/solvers/bench/merl_fit_sweep.h"

#include <glog/logging.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "ibrdf/brdf/void_bins.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/bench/merl_fit_summary.h"
#include "ibrdf/solvers/bench/sweep_files.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

// The last table that was read: cases of a material follow each other.
class TableReader {
 public:
  explicit TableReader(double void_beyond) : void_beyond_(void_beyond) {}

  // Null after an error, then in `status`.
  const MerlTable* Read(const std::string& path, Status* status) {
    if (path == path_) return &table_;
    path_.clear();
    StatusOr<MerlTable> table = ReadMerl(path);
    if (!table.ok()) {
      *status = table.status();
      return nullptr;
    }
    path_ = path;
    table_ = *std::move(table);
    VoidBeyond(void_beyond_, &table_);
    return &table_;
  }

 private:
  const double void_beyond_;
  std::string path_;
  MerlTable table_;
};

NamedRow KeyOf(const MerlFitSweepOptions& options, const MerlFitCase& c) {
  NamedRow row(MerlFitColumns());
  row.Set("material", c.material);
  row.Set("method", c.fitter->method());
  row.Set("lobes", c.fitter->lobes());
  row.Set("model", c.fitter->model());
  row.Set("seed", std::to_string(options.seed));
  return row;
}

std::string NameOfStatus(const Status& status) {
  switch (status.code()) {
    case StatusCode::kOk:
      return "ok";
    case StatusCode::kInvalidInput:
      return "bad_input";
    case StatusCode::kNoImprovement:
      return "no_improvement";
    default:
      return "internal_error";
  }
}

// Fills the columns PREFIX_rmse, PREFIX_rmse_aligned and PREFIX_rmse_below80.
Status Score(const MerlTable& estimate, const MerlTable& reference,
             const std::string& prefix, NamedRow* row) {
  const StatusOr<BrdfMetrics> metrics = CompareBrdfs(estimate, reference);
  if (!metrics.ok()) return metrics.status();
  row->Set(prefix + "_rmse", NumberCell(metrics->log_rmse));
  row->Set(prefix + "_rmse_aligned", NumberCell(metrics->log_rmse_aligned));
  row->Set(prefix + "_rmse_below80", NumberCell(metrics->log_rmse_below80));
  return OkStatus();
}

Status FitAndScore(const MerlFitSweepOptions& options, const MerlFitCase& c,
                   const MerlTable& table, const MerlTable* score,
                   NamedRow* row) {
  TableFitContext context;
  context.material = c.material;
  context.seed = options.seed;
  context.num_threads = options.num_threads;
  context.stop = options.stop;
  const StatusOr<FittedTable> fit = c.fitter->Fit(table, context);
  if (!fit.ok()) return fit.status();
  row->Set("seconds", NumberCell(fit->seconds));
  IBRDF_RETURN_IF_ERROR(Score(fit->table, table, "brdf_log", row));
  if (score == nullptr) return OkStatus();
  return Score(fit->table, *score, "score_data_log", row);
}

Status RunCase(const MerlFitSweepOptions& options, const MerlFitCase& c,
               const std::string& results, TableReader* tables,
               TableReader* score_tables) {
  Status status;
  const MerlTable* table = tables->Read(c.table_path, &status);
  IBRDF_RETURN_IF_ERROR(status);
  const MerlTable* score = nullptr;
  if (!c.score_path.empty()) {
    score = score_tables->Read(c.score_path, &status);
    IBRDF_RETURN_IF_ERROR(status);
  }
  NamedRow row = KeyOf(options, c);
  status = FitAndScore(options, c, *table, score, &row);
  if (status.code() == StatusCode::kInterrupted ||
      (options.stop != nullptr && *options.stop)) {
    return Status(StatusCode::kInterrupted, c.name + ": interrupted");
  }
  if (!status.ok()) LOG(WARNING) << c.name << ": " << status.message();
  row.Set("status", NameOfStatus(status));
  return AppendResult(results, MerlFitColumns(), row.cells());
}

// The fitters that options select.
StatusOr<TableFitters> SelectFitters(const MerlFitSweepOptions& options) {
  std::set<std::string> known;
  std::string list;
  for (const auto& fitter : options.fitters) {
    if (!known.insert(fitter->method()).second) continue;
    list += (list.empty() ? "" : ", ") + fitter->method();
  }
  for (const std::string& method : options.methods) {
    if (known.count(method) == 0) {
      return InvalidInput("command line: --methods",
                          "expected some of: " + list + "; found " + method);
    }
  }
  TableFitters selected;
  for (const auto& fitter : options.fitters) {
    if (options.methods.empty() ||
        std::find(options.methods.begin(), options.methods.end(),
                  fitter->method()) != options.methods.end()) {
      selected.push_back(fitter);
    }
  }
  return selected;
}

StatusOr<std::string> FindTable(const std::string& folder,
                                const std::string& option,
                                const std::string& material) {
  std::string path = FindFile(folder, material, {".binary"});
  if (!path.empty()) return path;
  return InvalidInput(folder + ": " + option,
                      "expected a file " + material + ".binary");
}

}  // namespace

const std::vector<std::string>& MerlFitColumns() {
  static const std::vector<std::string> columns = {
      "material",
      "method",
      "lobes",
      "model",
      "seed",
      "seconds",
      "brdf_log_rmse",
      "brdf_log_rmse_aligned",
      "brdf_log_rmse_below80",
      "score_data_log_rmse",
      "score_data_log_rmse_aligned",
      "score_data_log_rmse_below80",
      "status"};
  return columns;
}

StatusOr<std::vector<MerlFitCase>> ListMerlFitCases(
    const MerlFitSweepOptions& options) {
  const StatusOr<TableFitters> fitters = SelectFitters(options);
  if (!fitters.ok()) return fitters.status();
  std::vector<std::string> materials = options.materials;
  if (materials.empty()) {
    StatusOr<std::vector<std::string>> all =
        ListNames(options.data, {".binary"});
    if (!all.ok()) return all.status();
    materials = *std::move(all);
  }
  std::vector<MerlFitCase> cases;
  for (size_t i = 0; i < materials.size(); ++i) {
    MerlFitCase c;
    c.material = materials[i];
    IBRDF_RETURN_IF_ERROR(CheckCaseName(c.material));
    const StatusOr<std::string> table =
        FindTable(options.data, "--materials", c.material);
    if (!table.ok()) return table.status();
    c.table_path = *table;
    if (!options.score_data.empty()) {
      const StatusOr<std::string> score =
          FindTable(options.score_data, "--score-data", c.material);
      if (!score.ok()) return score.status();
      c.score_path = *score;
    }
    if (static_cast<int>(i % options.only_count) != options.only_index - 1) {
      continue;
    }
    for (const auto& fitter : *fitters) {
      c.fitter = fitter;
      c.name = c.material;
      for (const std::string& part :
           {fitter->method(), fitter->lobes(), fitter->model()}) {
        if (!part.empty()) c.name += " " + part;
      }
      cases.push_back(c);
    }
  }
  if (cases.empty()) {
    return InvalidInput("command line", "expected at least one case");
  }
  return cases;
}

Status RunMerlFitSweep(const MerlFitSweepOptions& options) {
  const StatusOr<std::vector<MerlFitCase>> cases = ListMerlFitCases(options);
  if (!cases.ok()) return cases.status();
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) return InvalidInput(options.out, error.message());
  const std::string results = options.out + "/results.csv";
  const StatusOr<std::vector<ResultsRow>> present =
      ReadResults(results, MerlFitColumns());
  if (!present.ok()) return present.status();
  TableReader tables(options.void_beyond), score_tables(options.void_beyond);
  for (size_t i = 0; i < cases->size(); ++i) {
    const MerlFitCase& c = (*cases)[i];
    const bool done =
        HoldsCase(*present, KeyOf(options, c).cells(), kMerlFitKeyColumns);
    if (options.report) {
      options.report("case " + std::to_string(i + 1) + " / " +
                     std::to_string(cases->size()) + "  " + c.name +
                     (done ? "  (in results.csv)" : ""));
    }
    if (done) continue;
    IBRDF_RETURN_IF_ERROR(RunCase(options, c, results, &tables, &score_tables));
  }
  const StatusOr<std::vector<ResultsRow>> rows =
      ReadResults(results, MerlFitColumns());
  if (!rows.ok()) return rows.status();
  return WriteFileAtomically(
      options.out + "/results.md",
      ResultsMarkdown("# Fits to measured tables\n\n    " + options.command +
                          "\n\n" + SummarizeMerlFits(*rows) + "\n## All fits\n",
                      MerlFitColumns(), *rows));
}

}  // namespace ibrdf
