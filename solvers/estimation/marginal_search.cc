#include "ibrdf/solvers/estimation/marginal_search.h"

#include <glog/logging.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/table_lobes.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/estimation/search_settings.h"
#include "ibrdf/solvers/marginal/best_of_searches.h"
#include "ibrdf/solvers/priors/embedding_prior.h"

namespace ibrdf {
namespace {

// Shares of the time that remains, at most: the search for the reflectance, a
// second one, and that for the hyperparameters of the light under a known
// reflectance.
constexpr double kSearchShare = 0.55;
constexpr double kSecondSearchShare = 0.7;
constexpr double kLightSearchShare = 0.25;
// CoarseEvidence has these: enough for the best few materials to come near
// their optima.
const std::vector<SearchStage> kEvidenceStages = {{4, 2}, {2, 5}};
// A painted object has these, in the priors' own: the deviations of what
// FindFirstPaint leaves of paint, and the variance of the light's chroma.
constexpr double kLeftOfPaint = 0.3;
constexpr double kPaintedLightChroma = 0.1;
// The first paint rests on one lamp in an even room. What that leaves of the
// shading drifts over the surface; else lobes would mirror a light that makes
// it: a paper cup came out with 14 times its gloss (docs/notes/paint.md).
constexpr double kLeftOfShading = 0.15;

// At the search's deviation of bins, materials that are like the object's may
// cost more than mirrors, whose misfit light inside texels excuses
// (docs/notes/search.md). Larger ones tolerate that they are not the object's
// own.
constexpr double kTolerance = 3.0, kNextTolerance = 1.5;

void TolerateUnlikeMaterials(std::vector<double> of_rankings,
                             ReflectanceSearchOptions* o) {
  o->ranking_tolerances = std::move(of_rankings);
  o->coarse_stages[0].tolerance = kTolerance;
  if (o->coarse_stages.size() > 1) {
    o->coarse_stages[1].tolerance = kNextTolerance;
  }
}

// Before the light is known, pixels tell paint and a lamp by themselves; what
// is left is small. Under a lamp its chroma is hardly the light's, which else
// would explain paint at no cost. A weak one is the sky's brighter half, not a
// lamp that would be mirrored.
void AddPaint(const FirstPaint& first, ReflectanceSearchOptions* o) {
  if (first.light) {
    if (!first.natural_light) o->directional_lights = {first.light->direction};
    VLOG(1) << "a lamp of strength " << first.light->strength
            << " shades the paint; deviation at like normals "
            << first.deviation;
  }
  o->paint.emplace();
  o->paint->albedo = AlbedoPrior().Scaled(kLeftOfPaint);
  o->paint->albedo.own_luminance =
      std::max(o->paint->albedo.own_luminance, first.deviation);
  o->paint->albedo.smooth_luminance = kLeftOfShading;
  o->paint->mean = first.log_albedo;
  if (first.natural_light) return;
  o->process.chroma_variance *= kPaintedLightChroma;
  o->process.directional_light_chroma_variance *= kPaintedLightChroma;
}

// The setup's unknown reflectance, for a search with these options.
SearchedModel ModelOf(const SolveSetup& setup,
                      const ReflectanceSearchOptions& o) {
  return {FlowLobes::Factory(*setup.problem->model, setup.lobes->layout(),
                             setup.problem->num_threads),
          &setup.materials, BounceGainOf(setup, o.fine)};
}

// The same of a known reflectance. known: KnownMaterial's prior.
SearchedModel KnownModel(const SolveSetup& setup, const MaterialPrior& known,
                         const ReflectanceSearchOptions& o) {
  return {TableLobes::Factory(*setup.problem->known_brdf), &known,
          BounceGainOf(setup, o.fine)};
}

// A search's result at the materials' mean level.
ModelOptima OptimaOf(const ReflectanceSearchResult& found,
                     const SolveSetup& setup) {
  ModelOptima optima;
  optima.setup = &setup;
  optima.gauge = std::make_shared<const LevelGauge>(
      *setup.problem->model, setup.materials, setup.problem->num_threads);
  ReflectanceEstimate& out = optima.estimate;
  out.lobes = found.parameters;
  out.light = LightOf(found, optima.gauge->Fix(out.lobes.data()));
  out.initial_guess = found.initial_guess;
  out.initial_lobes = optima.LobesOf(out.initial_guess);
  out.covariance = found.covariance;
  out.ranking = RankMaterials(found.candidates);
  out.coarse_optima = found.coarse_optima;
  for (const MaterialCandidate& candidate : found.candidates) {
    if (std::isfinite(candidate.cost)) out.candidates.push_back(candidate);
  }
  return optima;
}

// One photograph leaves hardly a material without a light that explains it.
// Several contradict all but the object's own, and none of the model is that:
// their search begins with tolerance.
ReflectanceSearchOptions FirstSearch(size_t views, ReflectanceSearchOptions o) {
  if (views > 1) TolerateUnlikeMaterials({1.0, kTolerance}, &o);
  return o;
}

// Begins as the first search does not.
ReflectanceSearchOptions SecondSearch(size_t views,
                                      ReflectanceSearchOptions o) {
  if (views < 2) TolerateUnlikeMaterials({kTolerance}, &o);
  if (!o.report) return o;
  o.report = [report = std::move(o.report)](const std::string& stage,
                                            double cost, double misfit) {
    report("second search: " + stage, cost, misfit);
  };
  return o;
}

using Results = std::vector<ReflectanceSearchResult>;

std::vector<ModelOptima> OptimaOf(
    const Results& found, const std::vector<const SolveSetup*>& setups) {
  std::vector<ModelOptima> optima;
  for (const ReflectanceSearchResult& result : found) {
    VLOG(1) << "found from " << result.initial_guess
            << ", -log evidence: " << result.cost << " nats";
    optima.push_back(OptimaOf(result, *setups[result.model]));
  }
  return optima;
}

// What one search finds, or two together. The setups are of one problem, each
// with a model of its own.
StatusOr<std::vector<ModelOptima>> Search(
    const std::vector<const SolveSetup*>& setups, SolveContext* context,
    const FirstPaint* paint, const SearchAgain& again) {
  const SolveSetup& setup = *setups.front();
  const InverseProblem& problem = *setup.problem;
  const size_t views = problem.sheet.views.size();
  const Observations observed = SearchedPixels(setup);
  const auto options = [&](double share) {
    ReflectanceSearchOptions o = SearchOptions(share, setup, context);
    o.covariance = problem.solver.max_iterations > 0;
    if (paint != nullptr) AddPaint(*paint, &o);
    return o;
  };
  ReflectanceSearchOptions o = FirstSearch(views, options(kSearchShare));
  std::vector<SearchedModel> models;
  for (const SolveSetup* s : setups) models.push_back(ModelOf(*s, o));
  StatusOr<Results> first =
      SearchReflectances(models, problem.points, observed, o);
  const bool once =
      !again || problem.solver.max_iterations == 0 || context->Interrupted();
  if (first.ok()) {
    std::vector<ModelOptima> optima = OptimaOf(*first, setups);
    if (once || !again(optima)) return optima;
  } else if (once || first.status().code() == StatusCode::kInvalidInput) {
    return first.status();
  }
  o = SecondSearch(views, options(kSecondSearchShare));
  StatusOr<Results> second =
      SearchReflectances(models, problem.points, observed, o);
  if (o.Stopped() && !context->Interrupted()) {
    LOG(WARNING) << "the second search for the reflectance was ended by the "
                    "time limit; a larger solver.seconds gives it more";
  }
  if (!first.ok() && !second.ok()) return first.status();
  if (!second.ok()) return OptimaOf(*first, setups);
  if (!first.ok()) return OptimaOf(*second, setups);
  return OptimaOf(BestOfSearches(*std::move(first), *std::move(second)),
                  setups);
}

}  // namespace

std::vector<double> ModelOptima::LobesOf(const std::string& material) const {
  const MaterialPrior::Material* found = setup->materials.Find(material);
  if (found == nullptr) return {};
  std::vector<double> lobes = ToVector(found->parameters);
  if (gauge != nullptr) gauge->Fix(lobes.data());
  return lobes;
}

StatusOr<ReflectanceEstimate> EstimateReflectance(const SolveSetup& setup,
                                                  SolveContext* context,
                                                  const FirstPaint* paint) {
  StatusOr<std::vector<ModelOptima>> found =
      Search({&setup}, context, paint, {});
  if (!found.ok()) return found.status();
  return std::move(found->front().estimate);
}

StatusOr<std::vector<ModelOptima>> EstimateReflectances(
    const std::vector<const SolveSetup*>& setups, SolveContext* context,
    const SearchAgain& again) {
  return Search(setups, context, nullptr, again);
}

LightPosterior EstimateLightPosterior(const SolveSetup& setup,
                                      SolveContext* context) {
  const InverseProblem& problem = *setup.problem;
  if (problem.illumination_prior == IlluminationPrior::kNone ||
      problem.solver.max_iterations == 0) {
    return LightPosterior();
  }
  ReflectanceSearchOptions o = SearchOptions(kLightSearchShare, setup, context);
  o.covariance = false;
  const MaterialPrior known =
      KnownMaterial(ToEigen(TableLobes::KnownParameters()));
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      KnownModel(setup, known, o), problem.points, SearchedPixels(setup), o);
  return found.ok() ? LightOf(*found, 0.0) : LightPosterior();
}

double CoarseEvidence(const SolveSetup& setup, SolveContext* context,
                      const PaintPrior* paint) {
  const InverseProblem& problem = *setup.problem;
  ReflectanceSearchOptions o = CoarseSearchOptions(1.0, setup, context);
  o.coarse_stages = kEvidenceStages;
  LimitIterations(problem.solver.max_iterations, &o);
  o.report = {};
  if (paint != nullptr) o.paint = *paint;
  const MaterialPrior known =
      KnownMaterial(ToEigen(TableLobes::KnownParameters()));
  const SearchedModel model =
      setup.lobes_unknown() ? ModelOf(setup, o) : KnownModel(setup, known, o);
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance(model, problem.points, SearchedPixels(setup), o);
  return found.ok() ? found->cost : std::numeric_limits<double>::infinity();
}

ReflectanceEstimate MeanMaterial(const SolveSetup& setup) {
  ReflectanceEstimate out;
  out.initial_guess = SpreadMaterials(*setup.problem->model, 1).front().name;
  out.lobes = ToVector(setup.materials.Find(out.initial_guess)->parameters);
  out.initial_lobes = out.lobes;
  return out;
}

}  // namespace ibrdf
