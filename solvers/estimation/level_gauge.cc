#include "ibrdf/solvers/estimation/level_gauge.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ibrdf {
namespace {

// A mean needs few nodes.
constexpr BrdfGridShape kGrid = {24, 10, 6};
constexpr double kFloor = 1e-9;  // 1/sr

}  // namespace

LevelGauge::LevelGauge(const NeuralBrdfModel& model, const MaterialPrior& prior,
                       int num_threads)
    : lobes_(model, prior.num_lobes(), kGrid, num_threads) {
  CHECK(!prior.materials.empty());
  for (const MaterialPrior::Material& m : prior.materials) {
    mean_ += MeanLog(m.parameters.data()) /
             static_cast<double>(prior.materials.size());
  }
}

double LevelGauge::Fix(double* parameters) const {
  const double level = mean_ - MeanLog(parameters);
  lobes_.Mixture(parameters).ShiftColours(Eigen::Array3d::Constant(level));
  return level;
}

double LevelGauge::MeanLog(const double* parameters) const {
  const BrdfGrid grid = lobes_.Grid(parameters);
  double sum = 0.0;
  for (const float v : grid.values) {
    sum += std::log(std::max(static_cast<double>(v), 0.0) + kFloor);
  }
  return sum / static_cast<double>(grid.values.size());
}

}  // namespace ibrdf
