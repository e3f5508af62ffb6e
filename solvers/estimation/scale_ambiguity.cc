#include "ibrdf/solvers/estimation/scale_ambiguity.h"

#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/light/log_map.h"

namespace ibrdf {
namespace {

// A mean needs few nodes.
constexpr BrdfGridShape kGrid = {24, 10, 6};
constexpr double kFloor = 1e-9;  // 1/sr
// Standard deviation of log (red / green) and log (blue / green) of a map's
// mean log radiance (experiments/light_statistics).
constexpr double kLightChromaStd = 0.35;

void ScaleLobes(const Eigen::Array3d& shift, int code_size,
                std::vector<double>* lobes) {
  if (lobes->empty()) return;
  MutableLobeMixture(LobeLayout::OfSize(lobes->size(), code_size),
                     lobes->data())
      .ShiftColours(shift);
}

void ScaleSlice(const Eigen::Array3d& scale, BrdfSlice* slice) {
  for (int c = 0; c < 3; ++c) {
    for (std::vector<double>* values :
         {&slice->value[c], &slice->low[c], &slice->high[c]}) {
      for (double& v : *values) v *= scale[c];
    }
  }
}

void DivideChannels(const Eigen::Array3d& scale, Image* image) {
  for (size_t i = 0; i < image->rgb.size(); ++i) {
    image->rgb[i] = static_cast<float>(image->rgb[i] / scale[i % 3]);
  }
}

// All that is said of a material's reflectance, times exp(shift).
void ScaleReflectance(const Eigen::Array3d& shift, int code_size,
                      MaterialSolution* material) {
  const Eigen::Array3d scale = shift.exp();
  ScaleLobes(shift, code_size, &material->lobe_parameters);
  for (Alternative& other : material->alternatives) {
    ScaleLobes(shift, code_size, &other.lobe_parameters);
  }
  for (BrdfSlice& slice : material->slices) ScaleSlice(scale, &slice);
  std::vector<double>& raw = material->brdf.raw;
  for (size_t i = 0; i < raw.size(); ++i) {
    // Negative values mark invalid bins.
    if (raw[i] > 0.0) raw[i] *= scale[i / kMerlBins];
  }
}

}  // namespace

LevelGauge::LevelGauge(const NeuralBrdfModel& model, const MaterialPrior& prior,
                       int num_threads)
    : lobes_(model, prior.layout(), kGrid, num_threads) {
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

void LevelGauge::Shift(double level, int num_materials,
                       double* parameters) const {
  for (int m = 0; m < num_materials; ++m) {
    lobes_.Mixture(parameters + m * lobes_.num_parameters())
        .ShiftColours(Eigen::Array3d::Constant(level));
  }
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
  const LobeMixture mixture = lobes.Mixture(parameters.data());
  for (int k = 0; k < lobes.num_lobes(); ++k) {
    for (int c = 0; c < 3; ++c) {
      A(c, c) += w;
      b[c] += w * (prior.colour_mean[c] - mixture.log_colour(k)[c]);
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
  const std::vector<double> d =
      GaugeShift(*setup.lobes, setup.lobe_prior, state->lobes,
                 LogMapOf(*iterate).Mean().data(), kLightChromaStd);
  setup.lobes->Mixture(state->lobes.data())
      .ShiftColours(Eigen::Array3d(d[0], d[1], d[2]));
  const double back[3] = {-d[0], -d[1], -d[2]};
  map->ShiftChannels(back, state->light.data());
  map->ShiftChannels(back, iterate->light.priors.mean.data());
}

Eigen::Array3d LightGaugeShift(SolverGauge gauge, const Image& map) {
  if (gauge == SolverGauge::kPrior) return Eigen::Array3d::Zero();
  const Eigen::Array3d mean = MeanRadiance(map);
  if (!mean.log().isFinite().all()) return Eigen::Array3d::Zero();
  if (gauge == SolverGauge::kUnitLight) return mean.log();
  // By a power of two, so that another unit of radiance leaves all bits.
  const Eigen::Array3d log_mean =
      (mean * std::exp2(-std::ilogb(mean[1]))).log();
  return log_mean - log_mean.mean();
}

void SetGauge(SolverGauge gauge, int code_size, Solution* solution) {
  const Eigen::Array3d shift = LightGaugeShift(gauge, solution->map);
  const Eigen::Array3d scale = shift.exp();
  DivideChannels(scale, &solution->map);
  for (OtherLight& other : solution->other_lights) {
    DivideChannels(scale, &other.map);
  }
  ScaleReflectance(shift, code_size, &solution->reflectance());
  for (MaterialSolution& material : solution->materials) {
    ScaleReflectance(shift, code_size, &material);
  }
  std::vector<float>& albedo = solution->albedo.rgb;
  for (size_t i = 0; i < albedo.size(); ++i) {
    albedo[i] = static_cast<float>(albedo[i] * scale[i % 3]);
  }
}

}  // namespace ibrdf
