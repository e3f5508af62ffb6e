// A sweep whose cases are solved by the program ibrdf_solve.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/sweep_cases.h"

namespace ibrdf {

// Size of the estimated maps, and of the true ones that they are held against.
inline constexpr int kSweepMapWidth = 128;
inline constexpr int kSweepMapHeight = 64;

struct SolverSweepOptions : SweepOptions {
  std::string method = "auto";
  double solver_seconds = 120.0;  // budget of the solver
  std::string solver_program;

  // Fails where there is no program of the solver.
  Status Check() const;
};

struct SolverRun {
  SweepCase of;
  std::string problem_name;  // of the problem file in the case's folder
  std::string problem;       // its text
  std::string estimate;      // folder of the results in the case's folder
  NamedRow row;              // with the cells that name the run
  // Makes what the problem needs beside the inputs of its case, in the case's
  // folder. May be empty.
  std::function<Status(const std::string& folder)> prepare = {};
};

struct SolverSweep {
  std::string title;  // of results.md
  const std::vector<std::string>* columns = nullptr;
  int key_columns = 0;  // the first ones, which name a run
  std::vector<SolverRun> runs;
  // Fills further cells of the row once the solver has ended; `solved`: it left
  // an estimate. What it fails with is logged, unless a file that is gone or
  // could not be written is the cause. May be empty.
  std::function<Status(const SolverRun& run, const std::string& folder,
                       bool solved, NamedRow* row)>
      finish;
  // Markdown that results.md has above the table. May be empty.
  std::function<std::string()> summary;
};

// A row of these columns with material, map and geometry set.
NamedRow CaseRow(const SweepOptions& options, const SweepCase& c,
                 const std::vector<std::string>& columns);

// "solver: {...}" of a problem file.
std::string SolverYaml(const SolverSweepOptions& options);

// "truth: {...}" of a problem file with both unknown.
std::string JointTruthYaml(const SweepCase& c);

// The true map of a case at the estimate's size.
StatusOr<Image> TrueMap(const SweepOptions& options, const SweepCase& c);

// Sets the columns constant_map_relative_log_rmse and ..._aligned.
Status SetConstantMap(const Image& truth, NamedRow* row);

// Runs what out/results.csv does not hold yet: makes the inputs that are
// missing, runs the solver on each problem, and appends the row: seconds,
// cpu_seconds, peak_mb, status and those metrics of result.json, and errors
// that it expects, that are columns. Then writes out/results.md. A solver that
// fails gets a row whose `status` says how; one that was interrupted gets none
// and ends the sweep (kInterrupted). So does one that misses a file which has
// gone since the sweep began, or that cannot write its results (kInvalidInput):
// the next call runs it again. A sweep begun with another size, noise, seed,
// budget or method, as out/settings.json says, is refused (kInvalidInput).
Status RunSolverSweep(const SolverSweepOptions& options,
                      const SolverSweep& sweep);

}  // namespace ibrdf
