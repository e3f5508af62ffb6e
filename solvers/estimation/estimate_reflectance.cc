#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/table_lobes.h"
#include "ibrdf/solvers/estimation/estimator.h"
#include "ibrdf/solvers/estimation/known_light_search.h"
#include "ibrdf/solvers/estimation/level_gauge.h"
#include "ibrdf/solvers/joint/reflectance_solver.h"
#include "ibrdf/solvers/priors/embedding_prior.h"
#include "ibrdf/solvers/problem/quadrature_level.h"

namespace ibrdf {
namespace {

// Of the time left, at most: the search for the reflectance.
constexpr double kSearchShare = 0.55;
// And for the scales of the light under a known one.
constexpr double kLightSearchShare = 0.25;
// Of the disc of normals: what a few dozen parameters under known light can
// learn from.
constexpr int kKnownLightBins = 26;
constexpr int kKnownLightStarts = 4;
constexpr int kKnownLightFinalists = 3;
// Of the trust region: of every start, and of a round.
constexpr int kStartSteps = 3;
constexpr int kRoundSteps = 6;
// Of the median radiance: no camera sees less, and its logarithm is far from
// all others.
constexpr double kDarkest = 1e-8;
// Where nearly all of a point's light comes from the object the map's says
// little of it.
constexpr double kMostBounceGain = 10.0;
// Far from the optimum, where steps fail, and near it.
constexpr double kStartRadius = 10.0;
constexpr double kRoundRadius = 300.0;

// Radiance [points][3] with bounces over that without, under a map of log
// radiance [3][texels].
std::vector<double> BounceGain(const Transport& transport, const BrdfGrid& grid,
                               const std::vector<double>& log_radiance) {
  const int texels = transport.map_height() * transport.map_width();
  if (log_radiance.size() != size_t{3} * texels) return {};
  // The level cancels in the ratio.
  const std::vector<float> map = RelativeMap(log_radiance.data(), texels);
  std::vector<double> direct(size_t{3} * transport.num_points());
  std::vector<double> all(direct.size());
  transport.RenderBounces(grid, map.data(), 0, direct.data());
  transport.Render(grid, map.data(), all.data());
  for (size_t i = 0; i < all.size(); ++i) {
    const double gain = all[i] / direct[i];
    all[i] = std::isfinite(gain) && gain > 0.0 ? std::min(gain, kMostBounceGain)
                                               : 1.0;
  }
  return all;
}

}  // namespace

ReflectanceSearchOptions Estimator::SearchOptions(double share) {
  ReflectanceSearchOptions o;
  o.num_threads = problem_.num_threads;
  for (MarginalResolution* resolution : {&o.screen, &o.coarse, &o.fine}) {
    resolution->visibility = problem_.transport.visibility;
    resolution->quadrature =
        AtLevel(resolution->quadrature, problem_.solver.quadrature);
  }
  o.should_stop = StopAfter(share);
  // The first stages of a small budget of iterations are cut short alike.
  const int iterations = problem_.solver.max_iterations;
  if (iterations == 0) o.coarse_stages = {{1, 0}};
  for (SearchStage& round : o.coarse_stages) {
    round.iterations = std::min(round.iterations, 5 * iterations);
  }
  o.fine_iterations = std::min(o.fine_iterations, 5 * iterations);
  o.report = [this](const std::string& stage, double cost, double misfit) {
    TraceEntry entry;
    entry.stage = stage;
    entry.pixels = full_->observed.num_valid;
    entry.cost = entry.likelihood = cost;
    entry.misfit = misfit;
    entry.seconds = Elapsed();
    Report(entry);
  };
  if (problem_.transport.patches != nullptr) {
    // Slice by slice of all points; the last one's transport is kept, which
    // spares a small image the making of another.
    o.bounce_gain = [this, shape = o.fine,
                     transport = std::shared_ptr<Transport>(), of = size_t{0}](
                        const std::vector<double>& lobes,
                        const std::vector<double>& log_radiance) mutable {
      const std::vector<ShadingPoint>& points = problem_.points;
      const BrdfGrid grid =
          lobes_unknown() ? lobes_->Grid(lobes.data()) : *problem_.known_brdf;
      std::vector<double> gain;
      for (size_t begin = 0; begin < points.size();
           begin += kPointsAtOnceWithBounces) {
        if (transport == nullptr || of != begin) {
          TransportOptions options = problem_.transport;
          options.num_threads = problem_.num_threads;
          const size_t end =
              std::min(begin + kPointsAtOnceWithBounces, points.size());
          transport.reset();  // the memory of one at a time
          transport = std::make_shared<Transport>(
              std::vector<ShadingPoint>(points.begin() + begin,
                                        points.begin() + end),
              shape.map_height, shape.map_width, options);
          of = begin;
        }
        const std::vector<double> of_slice =
            BounceGain(*transport, grid, log_radiance);
        if (of_slice.empty()) return of_slice;
        gain.insert(gain.end(), of_slice.begin(), of_slice.end());
      }
      return gain;
    };
  }
  return o;
}

std::vector<double> Estimator::SearchRadiance() const {
  std::vector<double> radiance = RadianceOf(problem_.image, problem_.points);
  std::vector<double> lit;
  for (const double e : radiance) {
    if (std::isfinite(e) && e > 0.0) lit.push_back(e);
  }
  if (lit.empty()) return radiance;
  const auto middle = lit.begin() + lit.size() / 2;
  std::nth_element(lit.begin(), middle, lit.end());
  const double darkest = kDarkest * *middle;
  for (double& e : radiance) {
    if (e < darkest) e = 0.0;
  }
  return radiance;
}

void Estimator::KeepLight(const ReflectanceSearchResult& found, double level) {
  light_hyperparameters_ = found.hyperparameters;
  directional_lights_ = found.directional_lights;
  mode_.clear();
  for (const double v : found.log_radiance) {
    mode_.push_back(static_cast<float>(v - level));
  }
  mode_size_ = {found.map_width, found.map_height};
  map_std_ =
      FromPlanes(found.log_radiance_std, found.map_width, found.map_height);
}

Status Estimator::SearchMarginal(JointState* state) {
  ReflectanceSearchOptions o = SearchOptions(kSearchShare);
  o.covariance = problem_.solver.max_iterations > 0;
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      FlowLobes::Factory(*problem_.model, problem_.lobes, problem_.num_threads),
      materials_, problem_.points, SearchRadiance(), o);
  if (!found.ok()) return found.status();
  state->lobes = found->parameters;
  const LevelGauge gauge(*problem_.model, materials_, problem_.num_threads);
  KeepLight(*found, gauge.Fix(state->lobes.data()));
  start_name_ = found->start;
  const auto& materials = materials_.materials;
  const auto start =
      std::find_if(materials.begin(), materials.end(),
                   [&](const auto& m) { return m.name == found->start; });
  first_.lobes = ToVector(start->parameters);
  gauge.Fix(first_.lobes.data());
  covariance_ = found->covariance;
  for (const TriedMaterial& tried : found->tried) {
    if (std::isfinite(tried.cost)) tried_.push_back(tried);
  }
  return OkStatus();
}

void Estimator::SearchLight() {
  ReflectanceSearchOptions o = SearchOptions(kLightSearchShare);
  o.covariance = false;
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance(TableLobes::Factory(*problem_.known_brdf),
                        KnownMaterial(ToEigen(TableLobes::KnownParameters())),
                        problem_.points, SearchRadiance(), o);
  if (found.ok()) KeepLight(*found, 0.0);
}

void Estimator::StartAtMeanMaterial(JointState* state) {
  const std::string name = SpreadMaterials(*problem_.model, 1).front().name;
  for (const MaterialPrior::Material& m : materials_.materials) {
    if (m.name != name) continue;
    state->lobes = ToVector(m.parameters);
  }
  start_name_ = name;
}

JointState Estimator::EstimateUnderKnownLight() {
  // Pixels as they are: under a known directional light the mean of a cell is
  // not the radiance of its mean normal.
  few_ = MakeSampleLevel(problem_, kKnownLightBins);
  const Transport& transport = TransportOf(few_.get());
  if (LobeRadianceCost::IsStored(transport)) {
    few_light_ = transport.ByReflectance(known_map_.data());
  }
  const std::vector<RankedMaterial> ranked = RankUnderKnownLight(
      transport, *lobes_, materials_, known_map_, few_->observed, likelihood_);
  first_.lobes = ranked.front().parameters;
  start_name_ = ranked.front().name;
  // The first as it is, too, should no step lower its cost.
  std::vector<Candidate> candidates = {CandidateOf(start_name_, first_)};
  Report(Entry("rank " + start_name_, candidates.front()));
  if (problem_.solver.max_iterations == 0) return first_;
  const std::function<bool()> stop = StopAfter(kSearchShare);
  const int starts =
      std::min<int>(kKnownLightStarts, static_cast<int>(ranked.size()));
  for (int k = 0; k < starts && !(k > 0 && stop()); ++k) {
    JointState next;
    next.lobes = ranked[k].parameters;
    LobeSteps(kStartSteps, kStartRadius, &next);
    candidates.push_back(CandidateOf(ranked[k].name, std::move(next)));
    Report(Entry("start " + ranked[k].name, candidates.back()));
  }
  return BestOf(std::move(candidates));
}

Estimator::Candidate Estimator::CandidateOf(const std::string& name,
                                            JointState state) {
  const LevelObjective on = ObjectiveOn(few_.get());
  Candidate candidate;
  candidate.name = name;
  candidate.priors = on.objective->Evaluate(state);
  candidate.radiance = on.objective->radiance();
  candidate.state = std::move(state);
  candidate.scale = likelihood_.scale;
  return candidate;
}

TraceEntry Estimator::Entry(const std::string& stage,
                            const Candidate& candidate) const {
  JointCost cost = candidate.priors;
  const LikelihoodValue value = EvaluateLikelihood(
      candidate.radiance, few_->observed, likelihood_, nullptr);
  cost.likelihood = value.cost;
  cost.misfit = value.misfit;
  return Entry(stage, *few_, candidate.state, cost);
}

JointState Estimator::BestOf(std::vector<Candidate> candidates) {
  KeepBest(kKnownLightFinalists, &candidates);
  const auto going = [](const Candidate& c) { return !c.settled; };
  while (iterations_ < problem_.solver.max_iterations &&
         std::any_of(candidates.begin(), candidates.end(), going)) {
    for (Candidate& c : candidates) {
      if (Interrupted() || Elapsed() > Budget() - finish_seconds_) {
        KeepBest(1, &candidates);
        return candidates.front().state;
      }
      if (!c.settled) KnownLightRound(&c);
    }
    ++iterations_;
    KeepBest(candidates.size() - 1, &candidates);
  }
  KeepBest(1, &candidates);
  return candidates.front().state;
}

void Estimator::KeepBest(size_t count, std::vector<Candidate>* candidates) {
  // At the first, tolerant scale ends differ by a few nats that differ by
  // hundreds at the image's own.
  for (const Candidate& c : *candidates) {
    likelihood_.scale = std::min(likelihood_.scale, c.scale);
  }
  for (Candidate& c : *candidates) c.cost = Entry("", c).cost;
  std::stable_sort(
      candidates->begin(), candidates->end(),
      [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  candidates->resize(std::min(std::max<size_t>(count, 1), candidates->size()));
  start_name_ = candidates->front().name;
}

void Estimator::LobeSteps(int max_steps, double radius,
                          JointState* state) const {
  ReflectanceStepOptions o;
  o.likelihood = likelihood_;
  o.materials = &materials_;
  o.stored = few_light_ ? &*few_light_ : nullptr;
  o.max_iterations = max_steps;
  o.trust_region_radius = radius;
  o.tolerance = problem_.solver.tolerance;
  o.should_stop = StopAfter(1.0);
  SolveReflectance(*few_->transport, *lobes_, known_map_, few_->observed, o,
                   &state->lobes);
}

void Estimator::KnownLightRound(Candidate* candidate) {
  likelihood_.scale = candidate->scale;
  UpdateScale(Entry("", *candidate).misfit);
  candidate->scale = likelihood_.scale;
  const TraceEntry before = Entry("", *candidate);
  JointState state = candidate->state;
  LobeSteps(kRoundSteps, kRoundRadius, &state);
  Candidate next = CandidateOf(candidate->name, std::move(state));
  const TraceEntry after =
      Entry("refine " + next.name + " round " + std::to_string(iterations_ + 1),
            next);
  if (!(after.cost < before.cost)) {
    candidate->settled = true;
    return;
  }
  *candidate = std::move(next);
  Report(after);
  candidate->settled = RoundsSettled(before, after);
}

}  // namespace ibrdf
