#include "ibrdf/solvers/estimation/reflectance_given_light.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/estimation/known_light_covariance.h"
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
// A highlight is rendered wrong where it is brighter than the image by this
// factor more than any pixel that was fitted is.
constexpr double kWrongFactor = 2.0;

// A reflectance and what the pixels look like in it.
struct Candidate {
  std::string name;
  JointState state;
  Eigen::Array3d ambient = Eigen::Array3d::Zero();
  JointCost priors;
  std::vector<double> radiance;  // [points * 3], without the ambient term
  double cost = 0.0;             // when candidates were last compared
  double scale = 0.0;            // of the likelihood
  bool settled = false;
};

class Search {
 public:
  Search(const SolveSetup& setup, Observation pixels, SolveContext* context)
      : setup_(setup),
        context_(context),
        pixels_(std::make_unique<ObservedPixels>(setup, std::move(pixels))),
        transport_(pixels_->TransportFrom(setup.map_size())),
        scale_(setup.initial_scale) {
    if (LobeRadianceCost::IsStored(transport_)) {
      stored_ = transport_.ByReflectance(setup.known_map.data());
    }
  }

  // `earlier`, of a search on fewer pixels, is a candidate too; may be null.
  Estimate Run(const Estimate* earlier);

 private:
  Candidate MakeCandidate(const std::string& name, JointState state,
                          const Eigen::Array3d& ambient);
  // At the present scale; renders nothing.
  TraceEntry Entry(const std::string& stage, const Candidate& candidate) const;
  // The best materials after some steps each, and the first one as it is.
  std::vector<Candidate> FirstCandidates(
      const std::vector<RankedMaterial>& ranked);
  // Outer iterations of all in turn, after each of which the worst is given up.
  // The one that is left comes first; the costs are at its scale.
  std::vector<Candidate> Finalists(std::vector<Candidate> candidates);
  // Sorts the first so many, at least one, best first: compared at one scale,
  // the least of theirs, which is the likelihood's then.
  void SortBest(size_t count, std::vector<Candidate>* candidates);
  // Steps at a scale that may fall, unless they do not lower the cost.
  void OuterIteration(Candidate* candidate);
  // At most so many steps of the lobes and an unknown ambient term, from a
  // trust region of this radius.
  void Step(int max_steps, double radius, JointState* state,
            Eigen::Array3d* ambient) const;

  const SolveSetup& setup_;
  SolveContext* const context_;
  std::unique_ptr<ObservedPixels> pixels_;
  const Transport& transport_;
  std::optional<ReflectanceOperator> stored_;  // of the known map
  double scale_;
};

Estimate Search::Run(const Estimate* earlier) {
  const std::vector<RankedMaterial> ranked = RankUnderKnownLight(
      transport_, *setup_.lobes, setup_.materials, setup_.known_map,
      pixels_->observed(), LikelihoodOf(setup_, scale_, setup_.ambient.mean));
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

std::vector<Candidate> Search::FirstCandidates(
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
    JointState next;
    next.lobes = ranked[k].parameters;
    Eigen::Array3d ambient = setup_.ambient.mean;
    Step(kFirstSteps, kFirstRadius, &next, &ambient);
    candidates.push_back(
        MakeCandidate(ranked[k].name, std::move(next), ambient));
    context_->Report(Entry("candidate " + ranked[k].name, candidates.back()));
  }
  return candidates;
}

Candidate Search::MakeCandidate(const std::string& name, JointState state,
                                const Eigen::Array3d& ambient) {
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

TraceEntry Search::Entry(const std::string& stage,
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

std::vector<Candidate> Search::Finalists(std::vector<Candidate> candidates) {
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

void Search::SortBest(size_t count, std::vector<Candidate>* candidates) {
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

void Search::OuterIteration(Candidate* candidate) {
  scale_ = candidate->scale;
  scale_ = NextScale(setup_, scale_, Entry("", *candidate).misfit);
  candidate->scale = scale_;
  const TraceEntry before = Entry("", *candidate);
  JointState state = candidate->state;
  Eigen::Array3d ambient = candidate->ambient;
  Step(kSteps, kRadius, &state, &ambient);
  Candidate next = MakeCandidate(candidate->name, std::move(state), ambient);
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

void Search::Step(int max_steps, double radius, JointState* state,
                  Eigen::Array3d* ambient) const {
  ReflectanceStepOptions o;
  o.likelihood = LikelihoodOf(setup_, scale_, *ambient);
  if (setup_.ambient.unknown()) o.ambient = &setup_.ambient;
  o.materials = &setup_.materials;
  o.stored = stored_ ? &*stored_ : nullptr;
  o.max_iterations = max_steps;
  o.trust_region_radius = radius;
  o.tolerance = setup_.problem->solver.tolerance;
  o.should_stop = context_->StopAfter(1.0);
  SolveReflectance(transport_, *setup_.lobes, setup_.known_map,
                   pixels_->observed(), o, &state->lobes, ambient);
}

// The pixels in which a bright texel of the known map would be seen if the
// object were a mirror. One pixel per bin may leave the peak of a lobe that is
// narrower than a bin without any.
Observation HighlightsOf(const SolveSetup& setup) {
  std::vector<Eigen::Vector3d> lights;
  for (const BrightSample& sample : setup.transport.bright) {
    lights.push_back(sample.direction);
  }
  return Highlights(setup.pixels, lights, 2.0 / kBins);
}

// The largest factor by which an estimate is brighter than the image at some
// pixels.
double LargestExcess(const Estimate& estimate, const SolveSetup& setup,
                     ObservedPixels* pixels) {
  std::vector<double> L_o(3 * pixels->points().size());
  pixels->TransportFrom(setup.map_size())
      .Render(setup.lobes->Grid(estimate.iterate.state.lobes.data()),
              setup.known_map.data(), L_o.data());
  double largest = 1.0;
  for (size_t i = 0; i < L_o.size(); ++i) {
    if (!pixels->observed().valid[i / 3]) continue;
    largest = std::max(largest, (L_o[i] + estimate.iterate.ambient[i % 3]) /
                                    pixels->observed().Interval(i).high);
  }
  return largest;
}

// Whether an estimate has a peak that no pixel it was fitted to shows.
bool HasFalsePeak(const Estimate& estimate, const Observation& highlights,
                  const SolveSetup& setup) {
  if (highlights.points.empty()) return false;
  ObservedPixels pixels(setup, highlights);
  return LargestExcess(estimate, setup, &pixels) >
         kWrongFactor * LargestExcess(estimate, setup, estimate.pixels.get());
}

}  // namespace

void SetCovariance(const SolveSetup& setup, const SolveContext& context,
                   Estimate* estimate) {
  if (!context.IterationsLeft() || context.StopAfter(1.0)()) return;
  const Iterate& iterate = estimate->iterate;
  estimate->reflectance.covariance = KnownLightCovariance(
      estimate->pixels->TransportFrom(setup.map_size()), *setup.lobes,
      setup.materials, setup.known_map, estimate->pixels->observed(),
      LikelihoodOf(setup, iterate.scale, iterate.ambient), iterate.state.lobes);
}

Estimate EstimateLobesGivenLight(const SolveSetup& setup,
                                 SolveContext* context) {
  // Pixels as they are: under a known directional light the mean of a bin is
  // not the radiance of its mean normal.
  const Observation bins = OnePixelPerBin(setup.pixels, kBins);
  const Observation highlights = HighlightsOf(setup);
  const Observation both = Union(bins, highlights);
  // Under a lamp and nothing else every pixel shows one angle alone.
  const bool lamp = setup.problem->dark.num_unlit > 0;
  Estimate estimate = Search(setup, lamp ? both : bins, context).Run(nullptr);
  if (!lamp && context->IterationsLeft() && !context->Interrupted() &&
      context->Remaining() >= 0.0 &&
      HasFalsePeak(estimate, highlights, setup)) {
    estimate = Search(setup, both, context).Run(&estimate);
  }
  return estimate;
}

Estimate EstimateReflectanceGivenLight(const SolveSetup& setup,
                                       SolveContext* context) {
  Estimate estimate = EstimateLobesGivenLight(setup, context);
  estimate.reflectance.candidates.clear();
  SetCovariance(setup, *context, &estimate);
  return estimate;
}

}  // namespace ibrdf
