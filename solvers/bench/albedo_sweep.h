// The experiment `albedo`: energy of a model's materials and of their tables.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

struct AlbedoSweepOptions {
  std::string model;                   // "default" or a path
  std::string data;                    // folder of MERL tables, or empty
  std::string out;                     // folder of results
  std::vector<std::string> materials;  // empty: all of the model
  std::string command;                 // as typed, for results.md
  int num_threads = 0;
  const std::atomic<bool>* stop = nullptr;
  // A line per event; may be empty.
  std::function<void(const std::string&)> report;
};

// Columns of its results.csv, in order; the first three name the case.
const std::vector<std::string>& AlbedoColumns();
inline constexpr int kAlbedoKeyColumns = 3;

// For each material a row of the model and, where `data` holds its table, one
// of the table (FurnaceRules; albedo_N is the mean of the channels seen from N
// degrees). Of the model also the relative standard deviation of one sample of
// the albedo at 45 degrees, drawn by BrdfSampler and cosine-weighted. Rows that
// out/results.csv holds are not made again. Then writes out/results.md.
Status RunAlbedoSweep(const AlbedoSweepOptions& options);

}  // namespace ibrdf
