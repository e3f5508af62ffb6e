#include "ibrdf/solvers/estimation/candidate_search.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "ibrdf/solvers/estimation/outer_iterations.h"

namespace ibrdf {
namespace {

// The candidates' first steps spend at most this share of the time that
// remains.
constexpr double kCandidateShare = 0.55;
constexpr int kCandidates = 4;
constexpr int kFinalists = 3;
// Steps of the trust region for every candidate, and for an outer iteration.
constexpr int kFirstSteps = 3;
constexpr int kSteps = 6;
// Radii of the trust region: far from the optimum, where steps fail, and near
// it.
constexpr double kFirstRadius = 10.0;
constexpr double kRadius = 300.0;

}  // namespace

CandidateSearch::CandidateSearch(const SolveSetup& setup, Observation pixels,
                                 SolveContext* context)
    : setup_(setup),
      context_(context),
      steps_(setup, pixels),
      pixels_(std::make_unique<ObservedPixels>(setup, std::move(pixels))),
      scale_(setup.initial_scale) {}

Estimate CandidateSearch::Run(const Estimate* earlier) {
  const std::vector<RankedMaterial> ranked =
      steps_.Rank(LikelihoodOf(setup_, scale_, setup_.ambient.mean));
  Estimate estimate;
  estimate.reflectance.initial_lobes = ranked.front().parameters;
  estimate.reference.state.lobes = ranked.front().parameters;
  estimate.reference.ambient = setup_.ambient.mean;
  std::vector<Candidate> candidates = FirstCandidates(ranked);
  if (earlier != nullptr) {
    candidates.push_back(MakeCandidate(earlier->reflectance.initial_guess,
                                       earlier->iterate.state,
                                       earlier->iterate.ambient));
  }
  if (context_->IterationsLeft()) candidates = Finalists(std::move(candidates));
  for (const Candidate& c : candidates) {
    MaterialCandidate optimum;
    optimum.name = c.name;
    optimum.cost = c.cost;
    optimum.parameters = c.state.lobes;
    estimate.reflectance.candidates.push_back(std::move(optimum));
  }
  const Candidate& best = candidates.front();
  estimate.reflectance.initial_guess = best.name;
  estimate.reflectance.lobes = best.state.lobes;
  estimate.iterate.state = best.state;
  estimate.iterate.scale = scale_;
  estimate.iterate.ambient = best.ambient;
  estimate.pixels = std::move(pixels_);
  return estimate;
}

std::vector<CandidateSearch::Candidate> CandidateSearch::FirstCandidates(
    const std::vector<RankedMaterial>& ranked) {
  // The first as it is, too, should no step lower its cost.
  JointState first;
  first.lobes = ranked.front().parameters;
  std::vector<Candidate> candidates = {
      MakeCandidate(ranked.front().name, first, setup_.ambient.mean)};
  context_->Report(Entry("rank " + ranked.front().name, candidates.front()));
  if (!context_->IterationsLeft()) return candidates;
  const std::function<bool()> stop = context_->StopAfter(kCandidateShare);
  const int count = std::min<int>(kCandidates, static_cast<int>(ranked.size()));
  for (int k = 0; k < count && !(k > 0 && stop()); ++k) {
    JointState material;
    material.lobes = ranked[k].parameters;
    const Candidate from =
        k == 0 ? candidates.front()
               : MakeCandidate(ranked[k].name, material, setup_.ambient.mean);
    candidates.push_back(Moved(from, kFirstSteps, kFirstRadius));
    context_->Report(Entry("candidate " + ranked[k].name, candidates.back()));
  }
  return candidates;
}

CandidateSearch::Candidate CandidateSearch::MakeCandidate(
    const std::string& name, JointState state, const Eigen::Array3d& ambient) {
  const PosteriorObjective on =
      ObjectiveOn(pixels_.get(), setup_, LightModel(), LightPriors(), scale_);
  Candidate candidate;
  candidate.name = name;
  candidate.ambient = ambient;
  candidate.priors = on.objective->Evaluate(state);
  candidate.priors.illumination_prior += setup_.ambient.Cost(ambient);
  candidate.radiance = on.objective->radiance();
  candidate.state = std::move(state);
  candidate.scale = scale_;
  return candidate;
}

TraceEntry CandidateSearch::Entry(const std::string& stage,
                                  const Candidate& candidate) const {
  JointCost cost = candidate.priors;
  const LikelihoodValue value = EvaluateLikelihood(
      candidate.radiance, pixels_->observed(),
      LikelihoodOf(setup_, scale_, candidate.ambient), nullptr);
  cost.likelihood = value.cost;
  cost.misfit = value.misfit;
  return MakeEntry(stage, setup_, *context_, pixels_->observed().num_valid,
                   scale_, candidate.state, cost);
}

std::vector<CandidateSearch::Candidate> CandidateSearch::Finalists(
    std::vector<Candidate> candidates) {
  SortBest(candidates.size(), &candidates);
  candidates.resize(std::min<size_t>(kFinalists, candidates.size()));
  size_t going = candidates.size();
  const auto unsettled = [&] {
    return std::any_of(candidates.begin(), candidates.begin() + going,
                       [](const Candidate& c) { return !c.settled; });
  };
  const auto cut_short = [this] {
    return context_->Interrupted() || context_->Remaining() < 0.0;
  };
  while (context_->IterationsLeft() && unsettled() && !cut_short()) {
    for (size_t k = 0; k < going && !cut_short(); ++k) {
      if (!candidates[k].settled) OuterIteration(&candidates[k]);
    }
    if (cut_short()) break;
    context_->CountIteration();
    SortBest(going, &candidates);
    going = std::max<size_t>(going - 1, 1);
  }
  SortBest(going, &candidates);
  for (Candidate& c : candidates) c.cost = Entry("", c).cost;
  return candidates;
}

void CandidateSearch::SortBest(size_t count,
                               std::vector<Candidate>* candidates) {
  // At the first, tolerant scale candidates differ by a few nats that differ by
  // hundreds at the image's own.
  const auto end = candidates->begin() + std::max<size_t>(count, 1);
  for (auto c = candidates->begin(); c != end; ++c) {
    scale_ = std::min(scale_, c->scale);
  }
  for (auto c = candidates->begin(); c != end; ++c)
    c->cost = Entry("", *c).cost;
  std::stable_sort(
      candidates->begin(), end,
      [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
}

void CandidateSearch::OuterIteration(Candidate* candidate) {
  scale_ = candidate->scale;
  scale_ = NextScale(setup_, scale_, Entry("", *candidate).misfit);
  candidate->scale = scale_;
  const TraceEntry before = Entry("", *candidate);
  Candidate next = Moved(*candidate, kSteps, kRadius);
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

CandidateSearch::Candidate CandidateSearch::Moved(const Candidate& from,
                                                  int max_steps,
                                                  double radius) {
  CoarseSteps::Options options;
  options.max_steps = max_steps;
  options.radius = radius;
  options.scale = scale_;
  options.should_stop = context_->StopAfter(1.0);
  JointState state = from.state;
  Eigen::Array3d ambient = from.ambient;
  steps_.Take(options, from.radiance, &state, &ambient);
  return MakeCandidate(from.name, std::move(state), ambient);
}

}  // namespace ibrdf
