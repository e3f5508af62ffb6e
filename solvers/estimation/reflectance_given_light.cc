#include "ibrdf/solvers/estimation/reflectance_given_light.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/estimation/known_light_search.h"
#include "ibrdf/solvers/estimation/outer_iterations.h"
#include "ibrdf/solvers/joint/reflectance_solver.h"

namespace ibrdf {
namespace {

// The candidates' first steps spend at most this share of the time that
// remains.
constexpr double kCandidateShare = 0.55;
// Across the disc of normals: what a few dozen parameters under known light can
// learn from.
constexpr int kBins = 26;
constexpr int kCandidates = 4;
constexpr int kFinalists = 3;
// Steps of the trust region for every candidate, and for an outer iteration.
constexpr int kFirstSteps = 3;
constexpr int kSteps = 6;
// Radii of the trust region: far from the optimum, where steps fail, and near
// it.
constexpr double kFirstRadius = 10.0;
constexpr double kRadius = 300.0;

// A reflectance and what the pixels look like in it.
struct Candidate {
  std::string name;
  JointState state;
  JointCost priors;
  std::vector<double> radiance;  // [points * 3]
  double cost = 0.0;             // when candidates were last compared
  double scale = 0.0;            // of the likelihood
  bool settled = false;
};

class Search {
 public:
  Search(const SolveSetup& setup, SolveContext* context)
      : setup_(setup),
        context_(context),
        // Pixels as they are: under a known directional light the mean of a bin
        // is not the radiance of its mean normal.
        pixels_(std::make_unique<ObservedPixels>(
            setup, OnePixelPerBin(setup.pixels, kBins))),
        transport_(pixels_->TransportFrom(setup.map_size())),
        scale_(setup.initial_scale) {
    if (LobeRadianceCost::IsStored(transport_)) {
      stored_ = transport_.ByReflectance(setup.known_map.data());
    }
  }

  Estimate Run();

 private:
  Candidate MakeCandidate(const std::string& name, JointState state);
  // At the present scale; renders nothing.
  TraceEntry Entry(const std::string& stage, const Candidate& candidate) const;
  // The best materials after some steps each, and the first one as it is.
  std::vector<Candidate> FirstCandidates(
      const std::vector<RankedMaterial>& ranked);
  // Outer iterations of all in turn, after each of which the worst is given up.
  Candidate BestOf(std::vector<Candidate> candidates);
  // Keeps the best so many, at least one, best first: compared at one scale,
  // the least of theirs, which is the likelihood's then.
  void KeepBest(size_t count, std::vector<Candidate>* candidates);
  // Steps at a scale that may fall, unless they do not lower the cost.
  void OuterIteration(Candidate* candidate);
  // At most so many steps of the lobes, from a trust region of this radius.
  void Step(int max_steps, double radius, JointState* state) const;

  const SolveSetup& setup_;
  SolveContext* const context_;
  std::unique_ptr<ObservedPixels> pixels_;
  const Transport& transport_;
  std::optional<ReflectanceOperator> stored_;  // of the known map
  double scale_;
};

Estimate Search::Run() {
  const std::vector<RankedMaterial> ranked = RankUnderKnownLight(
      transport_, *setup_.lobes, setup_.materials, setup_.known_map,
      pixels_->observed(), LikelihoodOf(setup_, scale_));
  Estimate estimate;
  estimate.reflectance.initial_lobes = ranked.front().parameters;
  estimate.reference.state.lobes = ranked.front().parameters;
  std::vector<Candidate> candidates = FirstCandidates(ranked);
  const Candidate best = context_->IterationsLeft()
                             ? BestOf(std::move(candidates))
                             : candidates.front();
  estimate.reflectance.initial_guess = best.name;
  estimate.reflectance.lobes = best.state.lobes;
  estimate.iterate.state = best.state;
  estimate.iterate.scale = scale_;
  estimate.pixels = std::move(pixels_);
  return estimate;
}

std::vector<Candidate> Search::FirstCandidates(
    const std::vector<RankedMaterial>& ranked) {
  // The first as it is, too, should no step lower its cost.
  JointState first;
  first.lobes = ranked.front().parameters;
  std::vector<Candidate> candidates = {
      MakeCandidate(ranked.front().name, first)};
  context_->Report(Entry("rank " + ranked.front().name, candidates.front()));
  if (!context_->IterationsLeft()) return candidates;
  const std::function<bool()> stop = context_->StopAfter(kCandidateShare);
  const int count = std::min<int>(kCandidates, static_cast<int>(ranked.size()));
  for (int k = 0; k < count && !(k > 0 && stop()); ++k) {
    JointState next;
    next.lobes = ranked[k].parameters;
    Step(kFirstSteps, kFirstRadius, &next);
    candidates.push_back(MakeCandidate(ranked[k].name, std::move(next)));
    context_->Report(Entry("candidate " + ranked[k].name, candidates.back()));
  }
  return candidates;
}

Candidate Search::MakeCandidate(const std::string& name, JointState state) {
  const PosteriorObjective on =
      ObjectiveOn(pixels_.get(), setup_, LightModel(), LightPriors(), scale_);
  Candidate candidate;
  candidate.name = name;
  candidate.priors = on.objective->Evaluate(state);
  candidate.radiance = on.objective->radiance();
  candidate.state = std::move(state);
  candidate.scale = scale_;
  return candidate;
}

TraceEntry Search::Entry(const std::string& stage,
                         const Candidate& candidate) const {
  JointCost cost = candidate.priors;
  const LikelihoodValue value =
      EvaluateLikelihood(candidate.radiance, pixels_->observed(),
                         LikelihoodOf(setup_, scale_), nullptr);
  cost.likelihood = value.cost;
  cost.misfit = value.misfit;
  return MakeEntry(stage, setup_, *context_, pixels_->observed().num_valid,
                   scale_, candidate.state, cost);
}

Candidate Search::BestOf(std::vector<Candidate> candidates) {
  KeepBest(kFinalists, &candidates);
  const auto going = [](const Candidate& c) { return !c.settled; };
  while (context_->IterationsLeft() &&
         std::any_of(candidates.begin(), candidates.end(), going)) {
    for (Candidate& c : candidates) {
      if (context_->Interrupted() || context_->Remaining() < 0.0) {
        KeepBest(1, &candidates);
        return candidates.front();
      }
      if (!c.settled) OuterIteration(&c);
    }
    context_->CountIteration();
    KeepBest(candidates.size() - 1, &candidates);
  }
  KeepBest(1, &candidates);
  return candidates.front();
}

void Search::KeepBest(size_t count, std::vector<Candidate>* candidates) {
  // At the first, tolerant scale candidates differ by a few nats that differ by
  // hundreds at the image's own.
  for (const Candidate& c : *candidates) scale_ = std::min(scale_, c.scale);
  for (Candidate& c : *candidates) c.cost = Entry("", c).cost;
  std::stable_sort(
      candidates->begin(), candidates->end(),
      [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  candidates->resize(std::min(std::max<size_t>(count, 1), candidates->size()));
}

void Search::OuterIteration(Candidate* candidate) {
  scale_ = candidate->scale;
  scale_ = NextScale(setup_, scale_, Entry("", *candidate).misfit);
  candidate->scale = scale_;
  const TraceEntry before = Entry("", *candidate);
  JointState state = candidate->state;
  Step(kSteps, kRadius, &state);
  Candidate next = MakeCandidate(candidate->name, std::move(state));
  const TraceEntry after = Entry("refine " + next.name + " iteration " +
                                     std::to_string(context_->iterations() + 1),
                                 next);
  if (!(after.cost < before.cost)) {
    candidate->settled = true;
    return;
  }
  *candidate = std::move(next);
  context_->Report(after);
  candidate->settled = Settled(setup_, scale_, before, after);
}

void Search::Step(int max_steps, double radius, JointState* state) const {
  ReflectanceStepOptions o;
  o.likelihood = LikelihoodOf(setup_, scale_);
  o.materials = &setup_.materials;
  o.stored = stored_ ? &*stored_ : nullptr;
  o.max_iterations = max_steps;
  o.trust_region_radius = radius;
  o.tolerance = setup_.problem->solver.tolerance;
  o.should_stop = context_->StopAfter(1.0);
  SolveReflectance(transport_, *setup_.lobes, setup_.known_map,
                   pixels_->observed(), o, &state->lobes);
}

}  // namespace

Estimate EstimateReflectanceGivenLight(const SolveSetup& setup,
                                       SolveContext* context) {
  return Search(setup, context).Run();
}

}  // namespace ibrdf
