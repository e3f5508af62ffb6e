#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ibrdf/light/environment_map.h"
#include "solvers/estimate/estimator.h"
#include "solvers/joint/process_prior.h"
#include "solvers/log_map_fit.h"
#include "solvers/process_illumination.h"

namespace ibrdf {
namespace {

// Of the time left, at most: the map as a draw of the light's process; the last
// rounds, whose last steps take the rest.
constexpr double kProcessShare = 0.5;
constexpr double kMapShare = 0.9;
// Of the draw's misfit: a network beyond it is not finished.
constexpr double kWorseMisfit = 1.5;
// Maps are first found at this size or below.
constexpr int kProcessWidth = 128;

// [3][height][width] of an image [H, W, 3], between its centres bilinearly.
std::vector<float> Planar(const Image& map, int height, int width) {
  const size_t texels = static_cast<size_t>(height) * width;
  std::vector<float> out(3 * texels);
  for (size_t t = 0; t < texels; ++t) {
    const Eigen::Array3d value = LookUpMap(
        map, MapDirection(static_cast<double>(t / width) + 0.5,
                          static_cast<double>(t % width) + 0.5, height, width));
    for (size_t c = 0; c < 3; ++c) {
      out[c * texels + t] = static_cast<float>(value[c]);
    }
  }
  return out;
}

}  // namespace

std::unique_ptr<IlluminationModel> Estimator::MakeLight() const {
  if (problem_.illumination_prior == IlluminationPrior::kNone) {
    return MakeFreeIllumination(problem_.map_width, problem_.map_height);
  }
  IlluminationUnetOptions unet;
  unet.width = problem_.map_width;
  unet.height = problem_.map_height;
  unet.seed = problem_.seed;
  unet.num_threads = problem_.num_threads;
  return MakeUnetIllumination(unet);
}

void Estimator::SetLight(std::unique_ptr<IlluminationModel> light,
                         bool process_prior) {
  light_ = std::move(light);
  has_process_prior_ = process_prior;
  light_priors_.clear();
}

void Estimator::MatchLight(JointState* state) {
  const double zero[3] = {0, 0, 0};
  state->light = light_mean_ = light_->ConstantMap(zero);
  const LevelObjective on = ObjectiveOn(cells_.get());
  on.objective->Evaluate(*state);
  const std::vector<double>& E = on.objective->radiance();
  const Observations& o = cells_->observed;
  std::fill(level_, level_ + 3, 0.0);
  for (size_t i = 0; i < E.size(); ++i) {
    if (!o.valid[i / 3]) continue;
    level_[i % 3] +=
        (std::log(o.radiance[i]) - std::log(std::max(E[i], 0.0) + 1e-30)) /
        o.num_valid;
  }
  StartAtLevel(state);
}

void Estimator::StartAtLevel(JointState* state) {
  state->light = light_mean_ = light_->ConstantMap(level_);
  if (!has_process_prior_) return;
  light_priors_.clear();
  light_priors_.push_back(std::make_unique<ProcessPrior>(
      light_->height(), light_->width(), LightProcess(), light_amplitude_,
      (level_[0] + level_[1] + level_[2]) / 3));
}

Status Estimator::EstimateBoth(JointState* state) {
  StartAtMeanMaterial(state);
  SetLight(MakeLight(), true);
  MatchLight(state);
  FixGauge(state);
  first_ = *state;
  first_mean_ = light_mean_;
  Report("start", cells_.get(), *state);
  return Rounds("maximum", MethodFor(JointBlocks::kBoth), JointBlocks::kBoth,
                kMapShare, state);
}

Status Estimator::EstimateLight(JointState* state) {
  const bool none = problem_.illumination_prior == IlluminationPrior::kNone;
  if (none || problem_.solver.max_iterations == 0) {
    SetLight(MakeLight(), !none);
    MatchLight(state);
    first_.light = state->light;
    first_mean_ = light_mean_;
    Report("constant map", cells_.get(), *state);
    return Rounds("map", MethodFor(JointBlocks::kLight), JointBlocks::kLight,
                  kMapShare, state);
  }
  const bool network = problem_.illumination_prior == IlluminationPrior::kUNet;
  int width = problem_.map_width, height = problem_.map_height;
  while (network && width > kProcessWidth && width % 4 == 0 &&
         height % 2 == 0) {
    width /= 2;
    height /= 2;
  }
  SetLight(
      MakeProcessIllumination(width, height, LightProcess(), light_amplitude_),
      false);
  MatchLight(state);
  first_.light = state->light;
  first_mean_ = light_mean_;
  Report("constant map", cells_.get(), *state);
  if (mode_.num_pixels() > 0) {
    LogMapFitOptions o;
    o.should_stop = StopAfter(kProcessShare / 2);
    FitLogMap(Planar(mode_, height, width), o, light_.get(), &state->light);
  }
  // The draw itself has one fitting method; solver.method is the network's.
  IBRDF_RETURN_IF_ERROR(Rounds(
      "map",
      network ? JointMethod::kGaussNewton : MethodFor(JointBlocks::kLight),
      JointBlocks::kLight, network ? kProcessShare : kMapShare, state));
  if (!network) return OkStatus();
  Image log_map(width, height);
  std::vector<float> planar(light_->num_outputs());
  light_->Forward(state->light.data(), planar.data());
  const size_t texels = log_map.num_pixels();
  for (size_t i = 0; i < 3 * texels; ++i) {
    log_map.rgb[i] = planar[i % 3 * texels + i / 3];
  }
  const double draw_misfit = Evaluate("map", cells_.get(), *state).misfit;
  const std::vector<float> draw = state->light, draw_mean = light_mean_;
  const JointState draw_first = first_;
  std::unique_ptr<IlluminationModel> process = std::move(light_);
  SetLight(MakeLight(), true);
  StartAtLevel(state);
  first_.light = state->light;
  first_mean_ = light_mean_;
  LogMapFitOptions o;
  o.should_stop = StopAfter(kMapShare / 2);
  FitLogMap(Planar(log_map, problem_.map_height, problem_.map_width), o,
            light_.get(), &state->light);
  Report("network", cells_.get(), *state);
  IBRDF_RETURN_IF_ERROR(Rounds("network", MethodFor(JointBlocks::kLight),
                               JointBlocks::kLight, kMapShare, state));
  // Out of time before the network came near the draw: the draw it is.
  const double misfit = Evaluate("network", cells_.get(), *state).misfit;
  if (misfit > kWorseMisfit * draw_misfit &&
      process->width() == problem_.map_width) {
    SetLight(std::move(process), false);
    state->light = draw;
    light_mean_ = first_mean_ = draw_mean;
    first_ = draw_first;
    Report("map again", cells_.get(), *state);
  }
  return OkStatus();
}

}  // namespace ibrdf
