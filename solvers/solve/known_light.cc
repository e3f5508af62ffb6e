#include "ibrdf/solvers/solve/known_light.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/solvers/estimation/known_light_covariance.h"
#include "ibrdf/solvers/estimation/optimum_average.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"
#include "ibrdf/solvers/solve/residual_statistics.h"

namespace ibrdf {
namespace {

// Residuals of neighbouring pixels that correlate less are noise: no other
// model would explain them. The correlation of 2000 pixels of noise has a
// standard deviation of 0.013.
constexpr double kNoise = 0.05;

// One model's optimum.
struct Search {
  NamedModel model;
  OtherModel other;  // empty: the problem's own model
  const SolveSetup* setup = nullptr;
  Estimate estimate;
};

struct Searches {
  std::vector<Search> of_models;  // the problem's own first
  ResidualStatistics left;        // by that one
};

Search SearchOwn(const SolveSetup& setup, SolveContext* context) {
  Search search;
  search.model = {setup.problem->model_name, setup.problem->model};
  search.setup = &setup;
  search.estimate = EstimateLobesGivenLight(setup, setup.pixels, context);
  return search;
}

StatusOr<Search> SearchWith(const NamedModel& model,
                            const InverseProblem& problem,
                            SolveContext* context) {
  StatusOr<OtherModel> other = SetUpWith(model, problem);
  if (!other.ok()) return other.status();
  Search search = SearchOwn(*other->setup, context);
  search.other = *std::move(other);
  return search;
}

bool MayTryAnother(const SolveContext& context) {
  return context.IterationsLeft() && !context.Interrupted() &&
         context.Remaining() > 0.0;
}

// The optima with their costs at one scale, the least of theirs, which tells
// them apart, and at the pixels that the first was found from. Pixels count as
// in the covariance, so that the evidence is that of a joint estimate's bins.
std::vector<ModelOptima> OptimaOf(const SolveContext& context,
                                  std::vector<Search>* searches) {
  double scale = searches->front().estimate.iterate.scale;
  for (const Search& s : *searches) {
    scale = std::min(scale, s.estimate.iterate.scale);
  }
  ObservedPixels* const pixels = searches->front().estimate.pixels.get();
  const double share = IndependentShare(pixels->observed().num_valid);
  std::vector<ModelOptima> optima;
  for (Search& s : *searches) {
    Iterate& iterate = s.estimate.iterate;
    MaterialCandidate optimum;
    optimum.name = s.estimate.reflectance.initial_guess;
    optimum.parameters = iterate.state.lobes;
    const double own_scale = std::exchange(iterate.scale, scale);
    const TraceEntry entry = Evaluate("", *s.setup, context, iterate, pixels);
    iterate.scale = own_scale;
    optimum.cost = share * entry.likelihood + entry.reflectance_prior +
                   entry.illumination_prior;
    VLOG(1) << s.model.name << " costs " << optimum.cost;
    ModelOptima of_model;
    of_model.setup = s.setup;
    of_model.estimate = s.estimate.reflectance;
    of_model.estimate.candidates = {std::move(optimum)};
    optima.push_back(std::move(of_model));
  }
  return optima;
}

StatusOr<Searches> SearchModels(const SolveSetup& setup,
                                SolveContext* context) {
  Searches out;
  out.of_models.push_back(SearchOwn(setup, context));
  out.left = ResidualStatisticsOf(setup, out.of_models.front().estimate);
  if (out.left.correlation < kNoise) return out;
  for (const NamedModel& model : setup.problem->other_models) {
    if (!MayTryAnother(*context)) break;
    StatusOr<Search> other = SearchWith(model, *setup.problem, context);
    if (!other.ok()) return other.status();
    out.of_models.push_back(*std::move(other));
  }
  return out;
}

KnownLightEstimate MeanOf(Searches found, const SolveContext& context) {
  std::vector<Search>& searches = found.of_models;
  OptimumAverage mean = AverageOptima(OptimaOf(context, &searches));
  Search& best = searches[mean.model];
  KnownLightEstimate out;
  mean.estimate.structured_misfit = found.left.Structured();
  out.estimate = std::move(best.estimate);
  out.estimate.iterate.state.lobes = mean.estimate.lobes;
  out.estimate.reflectance = std::move(mean.estimate);
  out.other = std::move(best.other);
  std::swap(searches.front(), best);
  std::swap(mean.model_weights.front(), mean.model_weights[mean.model]);
  out.model_weights = std::move(mean.model_weights);
  for (Search& s : searches) out.models.push_back(std::move(s.model));
  return out;
}

}  // namespace

StatusOr<KnownLightEstimate> EstimateUnderKnownLight(const SolveSetup& setup,
                                                     SolveContext* context) {
  StatusOr<Searches> searches = SearchModels(setup, context);
  if (!searches.ok()) return searches.status();
  KnownLightEstimate found = MeanOf(*std::move(searches), *context);
  if (setup.problem->other_models.empty()) {
    found.models.clear();
    found.model_weights.clear();
  }
  found.estimate.reflectance.candidates.clear();
  SetCovariance(found.SetupOr(setup), *context, &found.estimate);
  return found;
}

}  // namespace ibrdf
