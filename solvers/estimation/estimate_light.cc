#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/estimator.h"
#include "ibrdf/solvers/illumination/log_map_fit.h"
#include "ibrdf/solvers/illumination/process_illumination.h"
#include "ibrdf/solvers/priors/process_prior.h"

namespace ibrdf {
namespace {

// Of the time left, at most: the map as a draw of the light's process; the last
// rounds, whose last steps take the rest.
constexpr double kProcessShare = 0.5;
constexpr double kMapShare = 0.9;
// Of the draw's misfit: beyond it the draw is kept, which is the smoother of
// the two where the image tells nothing and has the finer detail where it does.
constexpr double kWorseMisfit = 1.02;
// Of the misfit of an image of joined pixels, what joining them leaves out.
constexpr double kBlurredShare = 0.2;
// Radiance under a map of 1 that no material leaves.
constexpr double kBlack = 1e-12;
// Maps are first found at this size or below, where their sides halve; in no
// case at a larger one than a process's (ProcessSize).
constexpr int kProcessWidth = 128;

}  // namespace

std::unique_ptr<IlluminationModel> Estimator::MakeLight() const {
  if (problem_.illumination_prior == IlluminationPrior::kNone) {
    return MakeFreeIllumination(problem_.map_width, problem_.map_height);
  }
  IlluminationUnetOptions unet;
  unet.width = problem_.map_width;
  unet.height = problem_.map_height;
  unet.channels = problem_.unet_channels;
  unet.seed = problem_.seed;
  unet.num_threads = problem_.num_threads;
  return MakeUnetIllumination(unet);
}

void Estimator::SetLight(std::unique_ptr<IlluminationModel> light,
                         bool process_prior) {
  light_ = std::move(light);
  has_process_prior_ = process_prior;
  const double zero[3] = {0, 0, 0};
  light_priors_ = {light_->ConstantMap(zero), {}};
}

Eigen::Array3d Estimator::MatchedLevel(const std::vector<double>& lobes) {
  const double zero[3] = {0, 0, 0};
  const LevelObjective on = ObjectiveOn(cells_.get());
  on.objective->Evaluate(JointState{lobes, light_->ConstantMap(zero)});
  const std::vector<double>& L_o = on.objective->radiance();
  const Observations& o = cells_->observed;
  Eigen::Array3d level = Eigen::Array3d::Zero();
  Eigen::Array3d lit = Eigen::Array3d::Zero();
  for (size_t i = 0; i < L_o.size(); ++i) {
    // What reflects nothing says nothing of the light.
    if (!o.valid[i / 3] || !(L_o[i] > kBlack)) continue;
    const auto c = static_cast<Eigen::Index>(i % 3);
    level[c] += std::log(o.radiance[i]) - std::log(L_o[i]);
    lit[c] += 1.0;
  }
  const double of_all = level.sum() / std::max(lit.sum(), 1.0);
  return (lit > 0.0).select(level / lit.max(1.0), of_all);
}

Estimator::LightPriors Estimator::PriorsAt(const Eigen::Array3d& level) const {
  LightPriors priors;
  priors.mean = light_->ConstantMap(level.data());
  if (has_process_prior_) {
    priors.on_map.push_back(std::make_unique<ProcessPrior>(
        light_->height(), light_->width(), LightProcess(),
        light_hyperparameters_, level.mean(), directional_lights_));
  }
  return priors;
}

void Estimator::MatchLight(JointState* state) {
  level_ = MatchedLevel(state->lobes);
  StartAtLevel(state);
}

void Estimator::StartAtLevel(JointState* state) {
  light_priors_ = PriorsAt(level_);
  state->light = light_priors_.mean;
}

void Estimator::StartWithoutSearch(JointState* state) {
  StartAtMeanMaterial(state);
  first_.lobes = state->lobes;
  SetLight(MakeLight(),
           problem_.illumination_prior != IlluminationPrior::kNone);
  MatchLight(state);
  StartFirstLight();
}

void Estimator::StartFirstLight() {
  first_priors_ = PriorsAt(MatchedLevel(first_.lobes));
  first_.light = first_priors_.mean;
}

Status Estimator::EstimateBoth(JointState* state) {
  StartAtMeanMaterial(state);
  SetLight(MakeLight(), true);
  MatchLight(state);
  FixGauge(state);
  first_.lobes = state->lobes;
  MatchLight(state);
  StartFirstLight();
  Report("start", cells_.get(), *state);
  return Rounds("maximum", MethodFor(JointBlocks::kBoth), JointBlocks::kBoth,
                kMapShare, state);
}

Status Estimator::EstimateLight(JointState* state) {
  const JointMethod method = MethodFor(JointBlocks::kLight);
  const bool none = problem_.illumination_prior == IlluminationPrior::kNone;
  if (none || problem_.solver.max_iterations == 0) {
    SetLight(MakeLight(), !none);
    MatchLight(state);
    StartFirstLight();
    Report("constant map", cells_.get(), *state);
    return MapRounds(method, kMapShare, state);
  }
  if (!lobes_unknown()) SearchLight();
  const MapSize asked = {problem_.map_width, problem_.map_height};
  if (problem_.illumination_prior == IlluminationPrior::kProcess) {
    return EstimateDraw(asked, method, kMapShare, state);
  }
  MapSize size = asked;
  while (size.width > kProcessWidth && size.width % 4 == 0 &&
         size.height % 2 == 0) {
    size.width /= 2;
    size.height /= 2;
  }
  size = ProcessSize(size);
  // solver.method is the network's.
  const JointMethod of_draw = JointMethod::kGaussNewton;
  const std::function<bool()> cut_short = StopAfter(kProcessShare);
  IBRDF_RETURN_IF_ERROR(EstimateDraw(size, of_draw, kProcessShare, state));
  if (cut_short() && size == asked) {
    // What time is left serves the draw better than a network.
    return MapRounds(of_draw, kMapShare, state);
  }
  return EstimateNetwork(state);
}

Status Estimator::EstimateDraw(MapSize size, JointMethod method, double share,
                               JointState* state) {
  SetLight(MakeProcessIllumination(size.width, size.height, LightProcess(),
                                   light_hyperparameters_, directional_lights_),
           false);
  MatchLight(state);
  StartFirstLight();
  Report("constant map", cells_.get(), *state);
  if (!mode_.empty()) {
    LogMapFitOptions o;
    o.should_stop = StopAfter(kProcessShare / 2);
    FitLogMap(LogMap(mode_size_, mode_).Resized(size), o, light_.get(),
              &state->light);
  }
  return MapRounds(method, share, state);
}

Status Estimator::MapRounds(JointMethod method, double share,
                            JointState* state) {
  IBRDF_RETURN_IF_ERROR(
      Rounds("map", method, JointBlocks::kLight, share, state));
  if (!BinsBlur(*state)) return OkStatus();
  cells_ = MakeBinnedLevel(problem_, kFineMapBins);
  return Rounds("fine map", method, JointBlocks::kLight, share, state);
}

bool Estimator::BinsBlur(const JointState& state) {
  // Points in shadow are not joined. And what pixels tell beyond cells of an
  // estimated reflectance is as much its errors as the map.
  if (problem_.transport.visibility != nullptr || lobes_unknown()) return false;
  if (StopAfter(1.0)()) return false;
  // A dense method was found to take the coarser level.
  if (MethodFor(JointBlocks::kLight) == JointMethod::kTrustRegion) return false;
  LevelPair pair = MakeLevelPair(problem_, kMapBins);
  if (pair.bins->observed.num_valid == 0) return false;
  const auto radiance = [&](Level* level) {
    const LevelObjective on = ObjectiveOn(level);
    on.objective->Evaluate(state);
    return on.objective->radiance();
  };
  const double error = BinningError(*pair.pixels, radiance(pair.pixels.get()),
                                    radiance(pair.bins.get()), kMapBins);
  return error > kBlurredShare * Evaluate("map", cells_.get(), state).misfit;
}

Status Estimator::EstimateNetwork(JointState* state) {
  const double draw_misfit = Evaluate("map", cells_.get(), *state).misfit;
  const std::vector<float> draw = state->light;
  std::unique_ptr<IlluminationModel> process = std::move(light_);
  LogMap log_map;
  process->Forward(draw.data(), &log_map);
  SetLight(MakeLight(), true);
  StartAtLevel(state);
  StartFirstLight();
  LogMapFitOptions o;
  o.should_stop = StopAfter(kMapShare / 2);
  const MapSize size = light_->size(), drawn = process->size();
  FitLogMap(log_map.Resized(size), o, light_.get(), &state->light);
  Report("network", cells_.get(), *state);
  // A draw of another size is no map to fall back on.
  const double most_misfit = drawn == size ? kWorseMisfit * draw_misfit : 0.0;
  IBRDF_RETURN_IF_ERROR(Rounds("network", MethodFor(JointBlocks::kLight),
                               JointBlocks::kLight, kMapShare, state,
                               most_misfit));
  const double misfit = Evaluate("network", cells_.get(), *state).misfit;
  if (most_misfit > 0.0 && misfit > most_misfit) {
    SetLight(std::move(process), false);
    StartAtLevel(state);
    StartFirstLight();
    state->light = draw;
    Report("map: the draw kept", cells_.get(), *state);
  }
  return OkStatus();
}

}  // namespace ibrdf
