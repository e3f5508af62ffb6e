#include <algorithm>
#include <cmath>
#include <string>

#include "ibrdf/solvers/estimation/estimator.h"
#include "ibrdf/solvers/joint/reflectance_solver.h"

namespace ibrdf {
namespace {

constexpr double kScaleStep = 3.0;       // b falls by no more in a round
constexpr double kSmallestScale = 3e-3;  // below any real image's noise
// Rounds end where b falls by no more than to this share, and the cost by this
// many times the tolerance of a step.
constexpr double kSettledScale = 0.9;
constexpr double kRoundTolerance = 300.0;
// Standard deviation of log (red / green) and log (blue / green) of a map's
// mean log radiance (experiments/light_statistics).
constexpr double kLightChromaStd = 0.35;

}  // namespace

void Estimator::FixGauge(JointState* state) {
  if (!lobes_unknown() || !light_unknown()) return;
  LogMap log_map;
  light_->Forward(state->light.data(), &log_map);
  const std::vector<double> d =
      GaugeShift(*lobes_, lobe_prior_, state->lobes, log_map.Mean().data(),
                 kLightChromaStd);
  lobes_->ShiftColours(d.data(), state->lobes.data());
  const double back[3] = {-d[0], -d[1], -d[2]};
  light_->ShiftChannels(back, state->light.data());
  light_->ShiftChannels(back, light_priors_.mean.data());
}

JointMethod Estimator::MethodFor(JointBlocks blocks) const {
  switch (problem_.solver.method) {
    case SolverMethod::kAuto:
      break;
    case SolverMethod::kAlternating:
      return JointMethod::kAlternating;
    case SolverMethod::kGaussNewton:
      return JointMethod::kGaussNewton;
    case SolverMethod::kLbfgs:
      return JointMethod::kLbfgs;
    case SolverMethod::kAdam:
      return JointMethod::kAdam;
    case SolverMethod::kTrustRegion:
      return JointMethod::kTrustRegion;
  }
  return blocks == JointBlocks::kLight ? JointMethod::kGaussNewton
                                       : JointMethod::kAlternating;
}

Status Estimator::Rounds(const std::string& stage, JointMethod method,
                         JointBlocks blocks, double share, JointState* state,
                         double most_misfit) {
  Level* const level = cells_.get();
  const std::function<bool()> stop = StopAfter(share);
  if (stop() || iterations_ >= problem_.solver.max_iterations) {
    return OkStatus();
  }
  JointMethodOptions o;
  // The network's products cost more, and its fit leaves less to do.
  o.max_iterations = has_process_prior_ ? 3 : 4;
  o.max_cg_iterations = has_process_prior_ ? 20 : 40;
  if (blocks == JointBlocks::kBoth && method == JointMethod::kGaussNewton) {
    o.max_cg_iterations = 100;
    o.cg_forcing = 1e-4;
  }
  o.tolerance = problem_.solver.tolerance;
  o.should_stop = stop;
  o.adam_rounds = 1;
  // The reference runs as many rounds as it is given (Chen et al. 2020).
  const bool whole_schedule = method == JointMethod::kAdam;
  TraceEntry before = Evaluate(stage, level, *state);
  for (int round = 0; iterations_ < problem_.solver.max_iterations; ++round) {
    if (stop()) break;
    UpdateScale(before.misfit);
    const LevelObjective on = ObjectiveOn(level);
    if (lobes_unknown() && light_unknown()) on.objective->Free(blocks);
    IBRDF_RETURN_IF_ERROR(CheckJointMethod(method, *on.objective));
    before = Entry(stage, *level, *state, on.objective->Evaluate(*state));
    JointState next = *state;
    MinimiseJoint(method, on.objective.get(), &next, o);
    const std::vector<float> mean = light_priors_.mean;
    if (blocks == JointBlocks::kBoth) FixGauge(&next);
    const TraceEntry after =
        Evaluate(stage + " round " + std::to_string(round + 1), level, next);
    ++iterations_;
    if (!(after.cost < before.cost)) {
      light_priors_.mean = mean;
      if (whole_schedule) continue;
      break;
    }
    *state = next;
    Report(after);
    if (!whole_schedule && RoundsSettled(before, after)) break;
    if (OutOfReach(most_misfit, before, after)) break;
    before = after;
  }
  return OkStatus();
}

bool Estimator::RoundsSettled(const TraceEntry& before,
                              const TraceEntry& after) const {
  return ScaleFor(after.misfit) > kSettledScale * likelihood_.scale &&
         before.cost - after.cost < kRoundTolerance *
                                        problem_.solver.tolerance *
                                        std::max(after.cost, 1.0);
}

bool Estimator::OutOfReach(double misfit, const TraceEntry& before,
                           const TraceEntry& after) const {
  if (misfit <= 0.0 || after.misfit <= misfit) return false;
  const double gain = std::log(before.misfit / after.misfit);
  if (gain <= 0.0) return true;
  const double rounds = std::log(after.misfit / misfit) / gain;
  return rounds * (after.seconds - before.seconds) >
         Budget() - finish_seconds_ - after.seconds;
}

double Estimator::ScaleFor(double misfit) const {
  if (problem_.scale.has_value()) return *problem_.scale;
  return std::min(
      likelihood_.scale,
      std::max({misfit, likelihood_.scale / kScaleStep, kSmallestScale}));
}

void Estimator::UpdateScale(double misfit) {
  likelihood_.scale = ScaleFor(misfit);
}

}  // namespace ibrdf
