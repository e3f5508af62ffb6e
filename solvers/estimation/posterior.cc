#include "ibrdf/solvers/estimation/posterior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/solvers/priors/process_prior.h"

namespace ibrdf {
namespace {

// Radiance under a map of 1 that no material leaves.
constexpr double kBlack = 1e-12;

double ReflectancePrior(const SolveSetup& setup, const JointState& state) {
  const Eigen::VectorXd lobes = ToEigen(state.lobes);
  return setup.light_unknown() ? setup.materials.CostAtBestLevel(lobes)
                               : setup.materials.Cost(lobes, nullptr);
}

// The light's priors at its level, and a map there.
void CentreLight(Estimate* estimate) {
  LightModel* const light = &estimate->iterate.light;
  light->priors = PriorsAt(light->level, *light, estimate->reflectance.light);
  estimate->iterate.state.light = light->priors.mean;
}

}  // namespace

LogMap LogMapOf(const Iterate& iterate) {
  LogMap log_map;
  iterate.light.map->Forward(iterate.state.light.data(), &log_map);
  return log_map;
}

MapSize SizeOf(const LightModel& light, const SolveSetup& setup) {
  if (light.map == nullptr) return setup.map_size();
  return light.map->size();
}

LightModel MakeLightModel(std::unique_ptr<IlluminationModel> map,
                          bool has_process_prior) {
  LightModel light;
  light.map = std::move(map);
  light.has_process_prior = has_process_prior;
  const double zero[3] = {0, 0, 0};
  light.priors = {light.map->ConstantMap(zero), {}};
  return light;
}

LightPriors PriorsAt(const Eigen::Array3d& level, const LightModel& light,
                     const LightPosterior& posterior) {
  LightPriors priors;
  priors.mean = light.map->ConstantMap(level.data());
  if (light.has_process_prior) {
    priors.on_map.push_back(std::make_unique<ProcessPrior>(
        light.map->height(), light.map->width(), LightProcess(),
        posterior.hyperparameters, level.mean(), posterior.directional_lights));
  }
  return priors;
}

Eigen::Array3d MatchedLevel(const std::vector<double>& lobes,
                            const LightModel& light, const SolveSetup& setup,
                            ObservedPixels* pixels) {
  const double zero[3] = {0, 0, 0};
  const PosteriorObjective on =
      ObjectiveOn(pixels, setup, light, light.priors, setup.initial_scale);
  on.objective->Evaluate(JointState{lobes, light.map->ConstantMap(zero)});
  const std::vector<double>& L_o = on.objective->radiance();
  const Observations& observed = pixels->observed();
  Eigen::Array3d level = Eigen::Array3d::Zero();
  Eigen::Array3d lit = Eigen::Array3d::Zero();
  for (size_t i = 0; i < L_o.size(); ++i) {
    // What reflects nothing says nothing of the light.
    if (!observed.valid[i / 3] || !(L_o[i] > kBlack)) continue;
    const auto c = static_cast<Eigen::Index>(i % 3);
    level[c] += std::log(observed.radiance[i]) - std::log(L_o[i]);
    lit[c] += 1.0;
  }
  const double of_all = level.sum() / std::max(lit.sum(), 1.0);
  return (lit > 0.0).select(level / lit.max(1.0), of_all);
}

void BeginLight(LightModel light, const SolveSetup& setup, Estimate* estimate) {
  light.level = MatchedLevel(estimate->iterate.state.lobes, light, setup,
                             estimate->pixels.get());
  estimate->iterate.light = std::move(light);
  CentreLight(estimate);
}

void BeginLightAtLevel(LightModel light, Estimate* estimate) {
  light.level = estimate->iterate.light.level;
  estimate->iterate.light = std::move(light);
  CentreLight(estimate);
}

void SetReference(const SolveSetup& setup, Estimate* estimate) {
  const LightModel& light = estimate->iterate.light;
  Reference* const reference = &estimate->reference;
  reference->state.lobes = estimate->reflectance.initial_lobes;
  reference->priors = PriorsAt(MatchedLevel(reference->state.lobes, light,
                                            setup, estimate->pixels.get()),
                               light, estimate->reflectance.light);
  reference->state.light = reference->priors.mean;
}

RobustLogLikelihood LikelihoodOf(const SolveSetup& setup, double scale,
                                 const Eigen::Array3d& ambient) {
  RobustLogLikelihood likelihood;
  likelihood.scale = scale;
  likelihood.epsilon = setup.epsilon;
  likelihood.ambient = ambient;
  return likelihood;
}

PosteriorObjective ObjectiveOn(ObservedPixels* pixels, const SolveSetup& setup,
                               const LightModel& light,
                               const LightPriors& priors, double scale) {
  PosteriorObjective out;
  const Transport& transport = pixels->TransportFrom(SizeOf(light, setup));
  JointTerms terms;
  terms.observed = &pixels->observed();
  terms.likelihood = LikelihoodOf(setup, scale);
  if (setup.lobes_unknown()) {
    terms.transport = &transport;
    terms.lobes = setup.lobes.get();
    terms.lobe_prior = setup.lobe_prior;
  } else {
    const std::vector<BrdfGrid> grids = setup.GridsOf({});
    out.known_brdf =
        std::make_unique<LightOperator>(transport.ByLight(ByMaterial(grids)));
    terms.known_brdf = out.known_brdf.get();
  }
  if (setup.light_unknown()) {
    terms.illumination = light.map.get();
    terms.light_mean = priors.mean;
    for (const auto& prior : priors.on_map) {
      terms.light_priors.push_back(prior.get());
    }
  } else {
    terms.known_map = setup.known_map;
  }
  out.objective = std::make_unique<JointObjective>(std::move(terms));
  return out;
}

TraceEntry MakeEntry(const std::string& stage, const SolveSetup& setup,
                     const SolveContext& context, int num_pixels, double scale,
                     const JointState& state, const JointCost& cost) {
  TraceEntry entry;
  entry.stage = stage;
  entry.scale = scale;
  entry.pixels = num_pixels;
  entry.likelihood = cost.likelihood;
  entry.reflectance_prior = setup.lobes_unknown() && !setup.joint_maximum()
                                ? ReflectancePrior(setup, state)
                                : cost.reflectance_prior;
  entry.illumination_prior = cost.illumination_prior;
  entry.cost =
      entry.likelihood + entry.reflectance_prior + entry.illumination_prior;
  entry.misfit = cost.misfit;
  entry.seconds = context.Elapsed();
  return entry;
}

TraceEntry Evaluate(const std::string& stage, const SolveSetup& setup,
                    const SolveContext& context, const Iterate& iterate,
                    ObservedPixels* pixels) {
  const PosteriorObjective on = ObjectiveOn(
      pixels, setup, iterate.light, iterate.light.priors, iterate.scale);
  JointCost cost = on.objective->Evaluate(iterate.state);
  if ((iterate.ambient != 0.0).any()) {
    const LikelihoodValue value = EvaluateLikelihood(
        on.objective->radiance(), pixels->observed(),
        LikelihoodOf(setup, iterate.scale, iterate.ambient), nullptr);
    cost.likelihood = value.cost;
    cost.misfit = value.misfit;
  }
  cost.illumination_prior += setup.ambient.Cost(iterate.ambient);
  return MakeEntry(stage, setup, context, pixels->observed().num_valid,
                   iterate.scale, iterate.state, cost);
}

}  // namespace ibrdf
