// Measured tables as points of the flow's unit cube.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// A random subset of bins, the same for all materials, with the logarithm of
// raw value + kLogFloor of every distribution (material and channel).
struct TrainingData {
  std::vector<std::string> names;  // "material.red", ".green", ".blue", ...
  int num_points = 0;
  std::vector<float> x;        // [3][num_points], cube coordinates
  std::vector<float> log_raw;  // [names.size()][num_points]

  const float* LogRaw(int distribution) const {
    return log_raw.data() + static_cast<size_t>(distribution) * num_points;
  }
  // The points [begin, end) of every distribution.
  TrainingData Slice(int begin, int end) const;
};

inline constexpr double kLogFloor = 1e-6;

// Bins above the horizon in a seeded random order.
std::vector<int> ShuffledBins(uint64_t seed);

// Coordinates of bins, as TrainingData::x.
std::vector<float> CubeCoordinates(const std::vector<int>& bins);

// Reads every *.binary of `folder`, in order of name, but those in `leave_out`
// (names without extension; one that is not there is an error).
StatusOr<TrainingData> ReadTrainingData(
    const std::string& folder, const std::vector<std::string>& leave_out,
    int num_points, uint64_t seed);

}  // namespace ibrdf
