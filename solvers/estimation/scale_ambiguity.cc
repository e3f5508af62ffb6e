#include "ibrdf/solvers/estimation/scale_ambiguity.h"

#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

// A mean needs few nodes.
constexpr BrdfGridShape kGrid = {24, 10, 6};
constexpr double kFloor = 1e-9;  // 1/sr
// Standard deviation of log (red / green) and log (blue / green) of a map's
// mean log radiance (experiments/light_statistics).
constexpr double kLightChromaStd = 0.35;

// Mean log radiance by channel, weighted by solid angle, of planes [3][H][W].
Eigen::Array3d MeanLogRadiance(const std::vector<float>& log_map,
                               MapSize size) {
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < size.height; ++r) {
      const double w = TexelSolidAngle(r, size.height, size.width) / (4 * M_PI);
      for (int x = 0; x < size.width; ++x) {
        mean[c] +=
            w *
            log_map[(static_cast<size_t>(c) * size.height + r) * size.width +
                    x];
      }
    }
  }
  return mean;
}

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
  const double shift[3] = {level, level, level};
  lobes_.ShiftColours(shift, parameters);
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

std::vector<double> GaugeShift(const LobeModel& lobes, const LobePrior& prior,
                               const std::vector<double>& parameters,
                               const double* mean_log_radiance,
                               double light_std) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  const double w = 1.0 / (prior.colour_sigma * prior.colour_sigma);
  for (int k = 0; k < lobes.num_lobes(); ++k) {
    for (int c = 0; c < 3; ++c) {
      const double a =
          parameters[k * lobes.lobe_size() + lobes.code_size() + c];
      A(c, c) += w;
      b[c] += w * (prior.colour_mean[c] - a);
    }
  }
  const double v = 1.0 / (light_std * light_std);
  for (const int c : {0, 2}) {
    Eigen::Vector3d row = Eigen::Vector3d::Zero();
    row[c] = 1.0;
    row[1] = -1.0;
    A += v * row * row.transpose();
    b += v * row * (mean_log_radiance[c] - mean_log_radiance[1]);
  }
  const Eigen::Vector3d d = A.ldlt().solve(b);
  return {d[0], d[1], d[2]};
}

void SettleScale(const SolveSetup& setup, Iterate* iterate) {
  if (!setup.lobes_unknown() || !setup.light_unknown()) return;
  IlluminationModel* const map = iterate->light.map.get();
  JointState* const state = &iterate->state;
  std::vector<float> log_map(map->num_outputs());
  map->Forward(state->light.data(), log_map.data());
  const Eigen::Array3d mean =
      MeanLogRadiance(log_map, {map->width(), map->height()});
  const std::vector<double> d =
      GaugeShift(*setup.lobes, setup.lobe_prior, state->lobes, mean.data(),
                 kLightChromaStd);
  setup.lobes->ShiftColours(d.data(), state->lobes.data());
  const double back[3] = {-d[0], -d[1], -d[2]};
  map->ShiftChannels(back, state->light.data());
  map->ShiftChannels(back, iterate->light.priors.mean.data());
}

Eigen::Array3d LightGaugeShift(SolverGauge gauge, const Image& map) {
  if (gauge == SolverGauge::kPrior) return Eigen::Array3d::Zero();
  const Eigen::Array3d log_mean = MeanRadiance(map).log();
  if (!log_mean.isFinite().all()) return Eigen::Array3d::Zero();
  if (gauge == SolverGauge::kUnitLight) return log_mean;
  return log_mean - log_mean.mean();
}

void SetGauge(SolverGauge gauge, int num_lobes, Solution* solution) {
  const Eigen::Array3d shift = LightGaugeShift(gauge, solution->map);
  const Eigen::Array3d scale = shift.exp();
  std::vector<float>& map = solution->map.rgb;
  for (size_t i = 0; i < map.size(); ++i) {
    map[i] = static_cast<float>(map[i] / scale[i % 3]);
  }
  std::vector<double>& lobes = solution->lobe_parameters;
  const size_t size = lobes.size() / num_lobes;  // the last three are colours
  for (size_t i = 0; i < lobes.size(); ++i) {
    const size_t at = i % size;
    if (at + 3 >= size) lobes[i] += shift[at + 3 - size];
  }
  std::vector<double>& raw = solution->brdf.raw;
  for (size_t i = 0; i < raw.size(); ++i) {
    // Negative values mark invalid bins.
    if (raw[i] > 0.0) raw[i] *= scale[i / kMerlBins];
  }
}

}  // namespace ibrdf
