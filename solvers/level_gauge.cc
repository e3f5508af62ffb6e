#include "solvers/level_gauge.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {
namespace {

// A mean needs few nodes.
constexpr BrdfGridShape kGrid = {24, 10, 6};
constexpr double kFloor = 1e-9;  // 1/sr

double MeanLog(const LobeModel& lobes, const Eigen::VectorXd& parameters) {
  std::vector<float> fields;
  lobes.Tabulate(parameters.data(), false, &fields);
  const BrdfGrid grid = lobes.Combine(parameters.data(), fields, 1);
  double sum = 0.0;
  for (const float v : grid.values) {
    sum += std::log(std::max(static_cast<double>(v), 0.0) + kFloor);
  }
  return sum / static_cast<double>(grid.values.size());
}

}  // namespace

double LevelShift(const NeuralBrdfModel& model, const MaterialPrior& prior,
                  const Eigen::VectorXd& parameters, int num_threads) {
  CHECK(!prior.materials.empty());
  const LobeModel lobes(model, prior.num_lobes(), kGrid, num_threads);
  double mean = 0.0;
  for (const MaterialPrior::Material& m : prior.materials) {
    mean += MeanLog(lobes, m.parameters) /
            static_cast<double>(prior.materials.size());
  }
  return mean - MeanLog(lobes, parameters);
}

}  // namespace ibrdf
