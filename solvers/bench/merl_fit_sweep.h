// The sweep `merl-fit`: how well BRDF models fit measured tables.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/table_fitter.h"

namespace ibrdf {

struct MerlFitSweepOptions {
  std::string data;        // folder of MERL .binary tables: fitted and scored
  std::string score_data;  // another of the same names: scored only; or empty
  // Bins further from the normal, degrees in (0, 90], are neither fitted nor
  // scored. Rows that are present keep theirs, as those of another score_data.
  double void_beyond = 90.0;
  std::string out;
  std::vector<std::string> materials;  // empty: all of `data`, sorted
  std::vector<std::string> methods;    // empty: all fitters
  TableFitters fitters;                // to choose from, in order
  int only_index = 1;  // of only_count, from 1: every n-th material
  int only_count = 1;
  std::string command;  // as typed, for results.md
  uint64_t seed = 1;
  int num_threads = 0;
  const std::atomic<bool>* stop = nullptr;
  // A line per event; may be empty.
  std::function<void(const std::string&)> report;
};

struct MerlFitCase {
  std::string name;  // MATERIAL METHOD [LOBES] [MODEL]
  std::string material;
  std::string table_path;  // absolute
  std::string score_path;  // absolute; empty: none
  std::shared_ptr<const TableFitter> fitter;
};

// Columns of its results.csv, in order; the first five name the case.
const std::vector<std::string>& MerlFitColumns();
inline constexpr int kMerlFitKeyColumns = 5;

// The cases that options select, by material, then fitter. Fails on a method
// or material that is not there, naming the option.
StatusOr<std::vector<MerlFitCase>> ListMerlFitCases(
    const MerlFitSweepOptions& options);

// Runs the cases that out/results.csv does not hold yet, each appended as it
// finishes, and writes out/results.md. The scores are those of CompareBrdfs
// against the fitted table and, where there is score_data, against the table of
// the same name there; rows that are present keep theirs, so another score_data
// needs another `out`. A fit that fails gets a row whose `status` says
// how; one that was interrupted gets none and ends the sweep (kInterrupted).
Status RunMerlFitSweep(const MerlFitSweepOptions& options);

}  // namespace ibrdf
