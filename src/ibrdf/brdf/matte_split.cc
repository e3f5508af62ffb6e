#include "ibrdf/brdf/matte_split.h"

#include <algorithm>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kLeastThetaH = 40.0 * kDegree, kMostThetaH = 75.0 * kDegree,
                 kMostThetaD = 60.0 * kDegree;

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

}  // namespace

std::vector<float> MattePart(const BrdfGridShape& shape, const float* field) {
  std::vector<float> values;
  for (const int node : LevelNodes(shape)) values.push_back(field[node]);
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  const float level = *middle;
  std::vector<float> matte(field, field + shape.num_nodes());
  for (float& f : matte) f = std::min(f, level);
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
