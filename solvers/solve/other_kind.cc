#include "ibrdf/solvers/solve/other_kind.h"

#include <string>
#include <utility>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/lobe_distance.h"
#include "ibrdf/solvers/estimation/map_evidence.h"

namespace ibrdf {
namespace {

// Optima are of different kinds if the log-RMSE between them is this, after the
// best scale.
constexpr double kFarApart = 0.5;
constexpr size_t kMostKinds = 3;
// Coarse optima this much above the best one, nats, were given up rightly.
constexpr double kHopeless = 150.0;
// Less evidence than this, nats, is the prior's and the bins' own error.
constexpr double kDoubt = 100.0;
constexpr int kEvidenceMapWidth = 64;
// A held map that leaves so many times what the estimate's leaves is not
// finished, as under small lamps, and says nothing.
constexpr double kUnfinished = 1.6;
// Other kinds are asked for before this share of the time is spent.
constexpr double kLatest = 0.5;

struct Kind {
  std::string name;  // of the material it came from
  std::vector<double> lobes;
};

// They are coarse optima at the gauge's level, the best first.
std::vector<Kind> OtherKinds(const ModelOptima& found,
                             const Estimate& estimate) {
  std::vector<Kind> kinds;
  if (found.estimate.coarse_optima.empty()) return kinds;
  const double least = found.estimate.coarse_optima.front().cost;
  const SolveSetup& setup = *found.setup;
  const LobeDistance distance(FlowLobes::Factory(*setup.problem->model,
                                                 setup.lobes->layout(),
                                                 setup.problem->num_threads));
  std::vector<std::vector<double>> taken = {
      distance.LogValues(estimate.reflectance.lobes)};
  const auto is_far = [&](const std::vector<double>& values) {
    for (const std::vector<double>& other : taken) {
      if (!(distance.Aligned(values, other) >= kFarApart)) return false;
    }
    return true;
  };
  for (const CoarseOptimum& optimum : found.estimate.coarse_optima) {
    if (kinds.size() == kMostKinds || optimum.cost - least > kHopeless) break;
    std::vector<double> values = distance.LogValues(optimum.parameters);
    if (!is_far(values)) continue;
    taken.push_back(std::move(values));
    kinds.push_back({optimum.name, optimum.parameters});
    found.gauge->Fix(kinds.back().lobes.data());
  }
  return kinds;
}

// The problem of the light alone, for a reflectance that is held.
InverseProblem WithKnown(const SolveSetup& setup,
                         const std::vector<double>& lobes) {
  InverseProblem problem = *setup.problem;
  problem.known_brdf = setup.lobes->Grid(lobes.data());
  problem.model = nullptr;
  problem.other_models.clear();
  return problem;
}

struct HeldKind {
  MapEvidence evidence;
  LightPosterior light;  // by the search's resolution
};

// light: as a search has it under the lobes; null: it is sought.
StatusOr<HeldKind> Hold(const std::vector<double>& lobes,
                        const LightPosterior* light, const SolveSetup& of,
                        SolveContext* context) {
  InverseProblem problem = WithKnown(of, lobes);
  problem.seconds_spent = context->Elapsed();
  const StatusOr<SolveSetup> setup = SetUp(problem);
  if (!setup.ok()) return setup.status();
  const SolveProgress quiet;
  SolveContext own(problem, quiet, context->stop());
  own.Reserve(context->reserved());
  HeldKind held;
  held.light = light != nullptr ? *light : EstimateLightPosterior(*setup, &own);
  ReflectanceEstimate reflectance;
  reflectance.light = held.light;
  const StatusOr<Estimate> estimate = EstimateProcessLight(
      *setup, std::move(reflectance), kEvidenceMapWidth, &own);
  if (!estimate.ok()) return estimate.status();
  held.evidence = EvidenceOfMap(*setup, *estimate);
  return held;
}

void Report(const std::string& stage, const HeldKind& held,
            const SolveSetup& setup, SolveContext* context) {
  context->Report(stage, setup.pixels.observed.num_valid, held.evidence.cost,
                  held.evidence.misfit);
}

bool TimeIsUp(const SolveContext& context) {
  return context.Interrupted() ||
         context.Elapsed() > kLatest * context.budget();
}

}  // namespace

StatusOr<std::optional<RevisedReflectance>> FindOtherKind(
    const ModelOptima& found, const Estimate& estimate, SolveContext* context) {
  const std::optional<RevisedReflectance> none;
  const SolveSetup& setup = *found.setup;
  // Points in shadow are not binned: each map would take too long.
  if (setup.transport.visibility != nullptr || TimeIsUp(*context)) return none;
  const std::vector<Kind> kinds = OtherKinds(found, estimate);
  if (kinds.empty()) return none;
  const StatusOr<HeldKind> present = Hold(
      estimate.reflectance.lobes, &estimate.reflectance.light, setup, context);
  if (!present.ok()) return present.status();
  Report("hold the estimate", *present, setup, context);
  const double misfit =
      Evaluate("map", setup, *context, estimate.iterate, estimate.pixels.get())
          .misfit;
  if (present->evidence.misfit > kUnfinished * misfit) return none;
  HeldKind best = *present;
  const Kind* best_kind = nullptr;
  for (const Kind& kind : kinds) {
    if (TimeIsUp(*context)) break;
    StatusOr<HeldKind> held = Hold(kind.lobes, nullptr, setup, context);
    if (!held.ok()) return held.status();
    Report("hold " + kind.name, *held, setup, context);
    if (held->evidence.cost < best.evidence.cost) {
      best = *std::move(held);
      best_kind = &kind;
    }
  }
  if (context->Interrupted() ||
      !(best.evidence.cost < present->evidence.cost - kDoubt) ||
      best.light.mode.num_texels() == 0) {
    return none;
  }
  RevisedReflectance revised;
  revised.lobes = best_kind->lobes;
  // As after a search: a map that is finished is as sharp as this reflectance
  // asks for, and would hold the turns to it.
  revised.log_map =
      best.light.mode.Resized(SizeOf(estimate.iterate.light, setup));
  revised.light = std::move(best.light);
  revised.initial_lobes = found.LobesOf(best_kind->name);
  if (!revised.initial_lobes.empty()) revised.initial_guess = best_kind->name;
  return std::optional<RevisedReflectance>(std::move(revised));
}

}  // namespace ibrdf
