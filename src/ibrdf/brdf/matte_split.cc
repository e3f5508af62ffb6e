#include "ibrdf/brdf/matte_split.h"

#include <algorithm>
#include <utility>

#include "ibrdf/base/median.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

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

// The cap of each theta_d at a phi_d [d]: the median over the half vectors far
// from the normal, or the level where that is more. Beyond kMostColumn, and
// where a column has no such node, it is that of the nearest column below, else
// of the first that has one; the level where none has.
std::vector<float> Caps(const BrdfGridShape& shape, const float* field, int ip,
                        float level) {
  std::vector<float> caps(shape.d, level);
  int first = shape.d;
  for (int id = 0; id < shape.d; ++id) {
    std::vector<float> far;
    for (int ih = 0; ih < shape.h; ++ih) {
      const int node = shape.Node(ih, id, ip);
      const Eigen::Vector3d angles = shape.NodeAngles(node);
      if (angles[1] <= kMostColumn && angles[0] >= kLeastThetaH &&
          angles[0] <= kMostThetaH) {
        far.push_back(field[node]);
      }
    }
    if (!far.empty()) {
      caps[id] = std::max(level, UpperMedian(std::move(far)));
      first = std::min(first, id);
    } else if (id > first) {
      caps[id] = caps[id - 1];
    }
  }
  if (first < shape.d) std::fill_n(caps.begin(), first, caps[first]);
  return caps;
}

}  // namespace

std::vector<float> MattePart(const BrdfGridShape& shape, const float* field) {
  std::vector<float> values;
  for (const int node : LevelNodes(shape)) values.push_back(field[node]);
  const float level = UpperMedian(std::move(values));
  std::vector<float> matte(field, field + shape.num_nodes());
  for (int ip = 0; ip < shape.p; ++ip) {
    const std::vector<float> caps = Caps(shape, field, ip, level);
    for (int id = 0; id < shape.d; ++id) {
      for (int ih = 0; ih < shape.h; ++ih) {
        float& f = matte[shape.Node(ih, id, ip)];
        f = std::min(f, caps[id]);
      }
    }
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
