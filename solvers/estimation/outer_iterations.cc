#include "ibrdf/solvers/estimation/outer_iterations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/solvers/estimation/scale_ambiguity.h"

namespace ibrdf {
namespace {

constexpr double kScaleStep = 3.0;       // b falls by no more in an iteration
constexpr double kSmallestScale = 3e-3;  // below any real image's noise
// Iterations end where b falls by no more than to this share, and the cost by
// this many times the tolerance of a step.
constexpr double kSettledScale = 0.9;
constexpr double kSettledTolerance = 300.0;

JointMethodOptions InnerOptions(const OuterIterationOptions& options,
                                const SolveSetup& setup, bool has_process_prior,
                                std::function<bool()> stop) {
  JointMethodOptions o;
  // The network's products cost more, and its fit leaves less to do.
  o.max_iterations = has_process_prior ? 3 : 4;
  o.max_cg_iterations = has_process_prior ? 20 : 40;
  if (options.blocks == JointBlocks::kBoth &&
      options.method == JointMethod::kGaussNewton) {
    o.max_cg_iterations = 100;
    o.cg_forcing = 1e-4;
  }
  o.precondition_light = setup.reflectance_known();
  o.tolerance = setup.problem->solver.tolerance;
  o.should_stop = std::move(stop);
  o.adam_rounds = 1;
  return o;
}

// Whether iterations as quick and as good as the last would not come to a
// misfit in the time that remains; later ones rarely gain more.
bool OutOfReach(double misfit, const SolveContext& context,
                const TraceEntry& before, const TraceEntry& after) {
  if (misfit <= 0.0 || after.misfit <= misfit) return false;
  const double gain = std::log(before.misfit / after.misfit);
  if (gain <= 0.0) return true;
  const double iterations = std::log(after.misfit / misfit) / gain;
  return iterations * (after.seconds - before.seconds) >
         context.RemainingAt(after.seconds);
}

}  // namespace

double NextScale(const SolveSetup& setup, double scale, double misfit) {
  if (setup.problem->scale.has_value()) return *setup.problem->scale;
  return std::min(scale,
                  std::max({misfit, scale / kScaleStep, kSmallestScale}));
}

bool Settled(const SolveSetup& setup, double scale, const TraceEntry& before,
             const TraceEntry& after) {
  return NextScale(setup, scale, after.misfit) > kSettledScale * scale &&
         before.cost - after.cost < kSettledTolerance *
                                        setup.problem->solver.tolerance *
                                        std::max(after.cost, 1.0);
}

StatusOr<bool> RunOuterIterations(const OuterIterationOptions& options,
                                  const SolveSetup& setup,
                                  ObservedPixels* pixels, SolveContext* context,
                                  Iterate* iterate) {
  const std::function<bool()> stop = context->StopAfter(options.share);
  if (stop() || !context->IterationsLeft()) return false;
  LightModel& light = iterate->light;
  const JointMethodOptions inner =
      InnerOptions(options, setup, light.has_process_prior, stop);
  // The reference runs as many iterations as it is given (Chen et al. 2020).
  const bool whole_schedule = options.method == JointMethod::kAdam;
  TraceEntry before =
      Evaluate(options.stage, setup, *context, *iterate, pixels);
  for (int k = options.first; context->IterationsLeft() && !stop(); ++k) {
    if (k > options.last) return true;
    iterate->scale = NextScale(setup, iterate->scale, before.misfit);
    const PosteriorObjective on =
        ObjectiveOn(pixels, setup, light, light.priors, iterate->scale);
    if (setup.lobes_unknown() && setup.light_unknown()) {
      on.objective->Free(options.blocks);
    }
    IBRDF_RETURN_IF_ERROR(CheckJointMethod(options.method, *on.objective));
    before = MakeEntry(options.stage, setup, *context,
                       pixels->observed().num_valid, iterate->scale,
                       iterate->state, on.objective->Evaluate(iterate->state));
    const JointState last_state = iterate->state;
    const std::vector<float> last_mean = light.priors.mean;
    MinimiseJoint(options.method, on.objective.get(), &iterate->state, inner);
    if (options.blocks == JointBlocks::kBoth) SettleScale(setup, iterate);
    const TraceEntry after =
        Evaluate(options.stage + " iteration " + std::to_string(k), setup,
                 *context, *iterate, pixels);
    context->CountIteration();
    if (!(after.cost < before.cost)) {
      iterate->state = last_state;
      light.priors.mean = last_mean;
      if (whole_schedule) continue;
      break;
    }
    context->Report(after);
    if (!whole_schedule && Settled(setup, iterate->scale, before, after)) break;
    if (OutOfReach(options.most_misfit, *context, before, after)) break;
    before = after;
  }
  return false;
}

}  // namespace ibrdf
