// Measured tables as columns of the flow's unit cube.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {

inline constexpr double kLogFloor = 1e-6;
// In the place of a logarithm: the bin has no value. Tables mark one by a
// negative raw value.
inline constexpr float kNotMeasured = -std::numeric_limits<float>::infinity();

// Columns of constant (theta_d, phi_d), the same for all materials, with the
// logarithm of raw value + kLogFloor of every distribution (material and
// channel) at the theta_h above the horizon, or kNotMeasured.
struct TrainingData {
  std::vector<std::string> names;  // "material.red", ".green", ".blue", ...
  FlowColumns columns;             // points: the kMerlThetaH of a table
  std::vector<int> count;          // [columns], theta_h above the horizon: >= 1
  std::vector<float> log_raw;      // [names.size()][columns][kMerlThetaH]

  int num_columns() const { return columns.columns; }
  // [kMerlThetaH], of which the first count[column] mean something.
  const float* LogRaw(int distribution, int column) const {
    return log_raw.data() +
           (static_cast<size_t>(distribution) * num_columns() + column) *
               kMerlThetaH;
  }
  // The columns [begin, end) of every distribution.
  TrainingData Slice(int begin, int end) const;
  // Distributions at these indices.
  TrainingData Select(const std::vector<int>& distributions) const;
};

// `count` different columns in a seeded random order, as
// theta_d * kMerlPhiD + phi_d, drawn by the number of their bins above the
// horizon: a bin of any of them is then as likely as any other bin.
std::vector<int> DrawColumns(int count, uint64_t seed);

// Geometry of these columns, without distributions.
TrainingData ColumnsOfTable(const std::vector<int>& columns);

// Appends the three channels of a table under this name.
void AddTable(const MerlTable& table, const std::vector<int>& columns,
              const std::string& name, TrainingData* data);

// Every *.binary of `folder` in order of name, without extension. Fails where
// there is none.
StatusOr<std::vector<std::string>> ListTables(const std::string& folder);

struct TableFolder {
  std::string path;
  // Bins further from the normal than this, degrees in (0, 90], are not to be
  // trusted and count as not measured.
  double trusted_to = 90.0;
};

// Reads the tables of these folders but those in `leave_out`. One that is in
// none of them is an error, and so is a name that two of them have.
StatusOr<TrainingData> ReadTrainingData(
    const std::vector<TableFolder>& folders,
    const std::vector<std::string>& leave_out, int num_columns, uint64_t seed);

}  // namespace ibrdf
