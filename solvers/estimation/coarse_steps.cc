#include "ibrdf/solvers/estimation/coarse_steps.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/joint/reflectance_solver.h"

namespace ibrdf {
namespace {

// With fewer theta_h or theta_d the corrections need many more steps; phi_d
// hardly matters.
constexpr BrdfGridShape kGrid = {48, 20, 8};

BrdfGridShape NoFinerThan(const BrdfGridShape& most) {
  return {std::min(kGrid.h, most.h), std::min(kGrid.d, most.d),
          std::min(kGrid.p, most.p)};
}

// What steps read of a setup, with its lobes on the coarse grid.
SolveSetup OnCoarseGrid(const SolveSetup& setup) {
  SolveSetup out;
  out.problem = setup.problem;
  out.epsilon = setup.epsilon;
  out.initial_scale = setup.initial_scale;
  out.transport = setup.transport;
  out.transport.grid = NoFinerThan(setup.transport.grid);
  out.lobes = std::make_unique<FlowLobes>(
      *setup.problem->model, setup.lobes->layout(), out.transport.grid,
      setup.problem->num_threads);
  out.lobe_prior = setup.lobe_prior;
  out.materials = setup.materials;
  out.known_map = setup.known_map;
  out.ambient = setup.ambient;
  return out;
}

// The observations times what a grid makes of the radiance that a finer one
// has.
Observations Corrected(const Observations& observed,
                       const std::vector<double>& coarse,
                       const std::vector<double>& fine,
                       const RobustLogLikelihood& likelihood) {
  Observations out = observed;
  for (size_t i = 0; i < coarse.size(); ++i) {
    const double beside =
        likelihood.ambient[static_cast<int>(i % 3)] + likelihood.epsilon;
    const double factor = (coarse[i] + beside) / (fine[i] + beside);
    if (!std::isfinite(factor) || !(factor > 0.0)) continue;
    out.radiance[i] *= factor;
    if (observed.exact()) continue;
    out.low[i] *= factor;
    out.high[i] *= factor;
  }
  return out;
}

}  // namespace

CoarseSteps::CoarseSteps(const SolveSetup& setup, const Observation& pixels)
    : setup_(OnCoarseGrid(setup)),
      pixels_(setup_, pixels),
      transport_(pixels_.TransportFrom(setup_.map_size())) {
  if (LobeRadianceCost::IsStored(transport_)) {
    stored_ = transport_.ByReflectance(setup_.known_map.data());
  }
}

std::vector<RankedMaterial> CoarseSteps::Rank(
    const RobustLogLikelihood& likelihood) const {
  return RankUnderKnownLight(transport_, *setup_.lobes, setup_.materials,
                             setup_.known_map, pixels_.observed(), likelihood);
}

std::vector<double> CoarseSteps::Radiance(const JointState& state) {
  const PosteriorObjective on = ObjectiveOn(
      &pixels_, setup_, LightModel(), LightPriors(), setup_.initial_scale);
  on.objective->Evaluate(state);
  return on.objective->radiance();
}

void CoarseSteps::Take(const Options& options, const std::vector<double>& fine,
                       JointState* state, Eigen::Array3d* ambient) {
  ReflectanceStepOptions o;
  o.likelihood = LikelihoodOf(setup_, options.scale, *ambient);
  if (setup_.ambient.unknown()) o.ambient = &setup_.ambient;
  o.materials = &setup_.materials;
  o.stored = stored_ ? &*stored_ : nullptr;
  o.max_iterations = options.max_steps;
  o.trust_region_radius = options.radius;
  o.tolerance = setup_.problem->solver.tolerance;
  o.should_stop = options.should_stop;
  SolveReflectance(
      transport_, *setup_.lobes, setup_.known_map,
      Corrected(pixels_.observed(), Radiance(*state), fine, o.likelihood), o,
      &state->lobes, ambient);
}

}  // namespace ibrdf
