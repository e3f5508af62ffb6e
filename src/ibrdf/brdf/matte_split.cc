#include "ibrdf/brdf/matte_split.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kLeastThetaH = 40.0 * kDegree, kMostThetaH = 75.0 * kDegree,
                 kMostThetaD = 60.0 * kDegree, kMostColumn = 45.0 * kDegree;

// Where the level is read; all nodes of a grid that has none there.
std::vector<int> LevelNodes(const BrdfGridShape& shape) {
  std::vector<int> nodes;
  for (int i = 0; i < shape.num_nodes(); ++i) {
    const Eigen::Vector3d angles = shape.NodeAngles(i);
    if (angles[0] >= kLeastThetaH && angles[0] <= kMostThetaH &&
        angles[1] <= kMostThetaD) {
      nodes.push_back(i);
    }
  }
  if (nodes.empty()) {
    for (int i = 0; i < shape.num_nodes(); ++i) nodes.push_back(i);
  }
  return nodes;
}

float Median(std::vector<float>* values) {
  const auto middle = values->begin() + values->size() / 2;
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace

std::vector<float> MattePart(const BrdfGridShape& shape, const float* field) {
  std::vector<float> values;
  for (const int node : LevelNodes(shape)) values.push_back(field[node]);
  const float level = Median(&values);
  // By theta_d and phi_d, the column of a node: the first column has theta_d 0.
  std::map<std::pair<double, double>, std::vector<float>> columns;
  for (int i = 0; i < shape.num_nodes(); ++i) {
    const Eigen::Vector3d angles = shape.NodeAngles(i);
    if (angles[0] >= kLeastThetaH && angles[0] <= kMostThetaH) {
      columns[{angles[1], angles[2]}].push_back(field[i]);
    }
  }
  std::map<double, std::map<double, float>> caps;  // by phi_d, then theta_d
  for (auto& [column, of_column] : columns) {
    if (column.first > kMostColumn) continue;
    caps[column.second][column.first] = std::max(level, Median(&of_column));
  }
  std::vector<float> matte(field, field + shape.num_nodes());
  for (int i = 0; i < shape.num_nodes(); ++i) {
    const Eigen::Vector3d angles = shape.NodeAngles(i);
    const auto of_phi = caps.find(angles[2]);
    float cap = level;
    if (of_phi != caps.end()) {
      const auto next = of_phi->second.upper_bound(angles[1]);
      cap = next == of_phi->second.begin() ? next->second
                                           : std::prev(next)->second;
    }
    matte[i] = std::min(matte[i], cap);
  }
  return matte;
}

BrdfGrid MattePart(const BrdfGrid& brdf) {
  BrdfGrid matte(brdf.shape);
  for (int c = 0; c < 3; ++c) {
    const std::vector<float> part = MattePart(brdf.shape, brdf.Channel(c));
    std::copy(part.begin(), part.end(), matte.Channel(c));
  }
  return matte;
}

std::vector<float> MatteShapes(const LobeModel& lobes,
                               const double* parameters) {
  const size_t nodes = lobes.grid_shape().num_nodes();
  std::vector<float> fields, matte;
  lobes.Tabulate(parameters, false, &fields);
  for (int k = 0; k < lobes.num_lobes(); ++k) {
    const std::vector<float> part =
        MattePart(lobes.grid_shape(), &fields[k * nodes]);
    matte.insert(matte.end(), part.begin(), part.end());
  }
  return matte;
}

}  // namespace ibrdf
