// The experiment `embedding`: a model's materials as spheres.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "ibrdf/base/status.h"

namespace ibrdf {

struct EmbeddingOptions {
  std::string model;  // "default" or a path
  std::string data;   // folder of MERL tables to show beside, or empty
  std::string out;    // folder of results
  std::string from,
      to;  // ends of the walk; empty: the most matte, the glossiest
  int sphere_size = 150;  // pixels rendered; pages show them smaller
  int num_threads = 0;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string&)> report;  // a line per event
};

// Writes into `out`: embedding.png, principal axes of the codes (three channels
// of a material in a row) with a sphere for each material; walk.png, spheres on
// the line between two materials, codes and log colours interpolated;
// neighbours.png, the nearest in code space of eight materials from matte to
// glossy; embedding.csv, a row per material; variance.csv, shares of the axes.
Status DrawEmbedding(const EmbeddingOptions& options);

}  // namespace ibrdf
