// The sweep `joint`: reflectance and illumination from one image, over
// materials and maps, beside what baselines reach on the same images.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "solvers/bench/results_table.h"

namespace ibrdf {

struct JointSweepOptions {
  std::string data;  // folder of MERL .binary tables
  std::string maps;  // folder of .hdr or .exr maps
  std::string out;
  std::vector<std::string> materials;  // empty: all of `data`, sorted
  std::vector<std::string> map_names;  // empty: all of `maps`, sorted
  std::string geometry = "sphere";     // or a mesh file
  int size = 128;                      // of the square image, pixels
  int lobes = 2;
  std::string method = "auto";
  double solver_seconds = 120.0;  // budget of the solver
  double noise = 0.02;            // log-normal, of the images
  int only_index = 1;             // of only_count, from 1: every n-th case
  int only_count = 1;
  std::string solver_program;
  std::string command;  // as typed, for results.md
  uint64_t seed = 1;    // of the noise and of the solver
  int num_threads = 0;
  const std::atomic<bool>* stop = nullptr;
  // A line per event; may be empty.
  std::function<void(const std::string&)> report;
};

struct JointCase {
  std::string name;  // MATERIAL_MAP, for a mesh MATERIAL_MAP_MESH
  std::string material, map;
  std::string brdf_path, map_path;  // absolute
};

// Columns of its results.csv, in order; the first five name the case.
const std::vector<std::string>& JointColumns();
inline constexpr int kJointKeyColumns = 5;

// The cases that options select, by material, then map. Fails on a material or
// map that is not there.
StatusOr<std::vector<JointCase>> ListJointCases(
    const JointSweepOptions& options);

// Runs the cases that out/results.csv does not hold yet: renders
// out/cases/NAME/{input.exr, mask.png, input.json, joint.yaml} (kept when
// input.json says the same settings made them), runs the solver there into
// estimate_LOBES_METHOD/, fits the baselines and appends the row; then writes
// out/results.md. A solver that fails gets a row whose `status` says how; one
// that was interrupted gets none and ends the sweep (kInterrupted).
Status RunJointSweep(const JointSweepOptions& options);

}  // namespace ibrdf
