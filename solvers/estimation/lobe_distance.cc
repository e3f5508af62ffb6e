#include "ibrdf/solvers/estimation/lobe_distance.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"

namespace ibrdf {
namespace {

constexpr double kFloor = 1e-6;  // raw units, as of CompareBrdfs

}  // namespace

LobeDistance::LobeDistance(const LobeFactory& lobes, const BrdfGridShape& grid)
    : lobes_(lobes(grid)), weights_(grid.num_nodes()) {
  // Bins are spaced evenly in sqrt(theta_h), nodes between 0 and the bound of
  // it. Nodes at an end stand for half as much.
  double sum = 0.0;
  for (int node = 0; node < grid.num_nodes(); ++node) {
    const Eigen::Vector3d x = grid.NodePoint(node);
    const double bound = ThetaHBound(kPi / 2 * x[1], kPi * x[2]);
    double w = std::sqrt(std::max(bound, 0.0));
    for (const double end : {x[0], x[1]}) {
      if (end == 0.0 || end == 1.0) w *= 0.5;
    }
    weights_[node] = w;
    sum += w;
  }
  for (double& w : weights_) w /= sum;
}

std::vector<double> LobeDistance::LogValues(
    const std::vector<double>& parameters) const {
  const BrdfGrid grid = lobes_->Grid(parameters.data());
  std::vector<double> values(grid.values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const double raw = grid.values[i] / kMerlScale[i / weights_.size()];
    values[i] = std::log(std::max(raw, 0.0) + kFloor);
  }
  return values;
}

double LobeDistance::Aligned(const std::vector<double>& a,
                             const std::vector<double>& b) const {
  return Distance(a, b, /*aligned=*/true);
}

double LobeDistance::WithLevel(const std::vector<double>& a,
                               const std::vector<double>& b) const {
  return Distance(a, b, /*aligned=*/false);
}

double LobeDistance::Distance(const std::vector<double>& a,
                              const std::vector<double>& b,
                              bool aligned) const {
  CHECK_EQ(3 * weights_.size(), a.size());
  CHECK_EQ(a.size(), b.size());
  double squares = 0.0;
  for (size_t c = 0; c < 3; ++c) {
    const size_t first = c * weights_.size();
    double mean = 0.0, square = 0.0;
    for (size_t i = 0; i < weights_.size(); ++i) {
      const double d = a[first + i] - b[first + i];
      mean += weights_[i] * d;
      square += weights_[i] * d * d;
    }
    squares += aligned ? std::max(square - mean * mean, 0.0) : square;
  }
  return std::sqrt(squares / 3.0);
}

Eigen::Array3d LobeDistance::MeanDifference(
    const std::vector<double>& a, const std::vector<double>& b) const {
  CHECK_EQ(3 * weights_.size(), a.size());
  CHECK_EQ(a.size(), b.size());
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  for (size_t i = 0; i < a.size(); ++i) {
    mean[static_cast<int>(i / weights_.size())] +=
        weights_[i % weights_.size()] * (a[i] - b[i]);
  }
  return mean;
}

}  // namespace ibrdf
