#include "ibrdf/solvers/solve/summary.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/pixel_renders.h"
#include "ibrdf/solvers/solve/reflectance_band.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

constexpr double kMisfitOfRounding = 1e-6;  // of radiance in floats
constexpr int kSpreadSamples = 64;
constexpr int kBandSamples = 200;
// The level of a band's sample needs no more nodes.
constexpr BrdfGridShape kLevelGrid = {18, 8, 8};
// The time of a summary over that of a transport of all pixels, which it builds
// and renders by; and that of the table and the samples of the posterior.
constexpr double kSummaryPerTransport = 1.4;
constexpr double kTableSeconds = 0.3;
constexpr size_t kProbePoints = 128;  // that a transport is timed on
// The share of the time that remains when it is predicted.
constexpr double kMostSummaryShare = 0.6;

// A state at every pixel.
struct View {
  JointCost cost;
  std::vector<BrdfGrid> grids;   // by material
  std::vector<float> map;        // [H, W, 3]
  std::vector<double> radiance;  // [pixels * 3], of the map's light
  Eigen::Array3d ambient = Eigen::Array3d::Zero();
};

// All but the likelihood of every pixel, and its radiance.
View ViewOf(const JointState& state, const LightPriors& priors,
            const Eigen::Array3d& ambient, const SolveSetup& setup,
            const Estimate& estimate) {
  // Priors and map are the same on any pixels.
  const PosteriorObjective on =
      ObjectiveOn(estimate.pixels.get(), setup, estimate.iterate.light, priors,
                  estimate.iterate.scale);
  View view;
  view.cost = on.objective->Evaluate(state);
  view.cost.illumination_prior += setup.ambient.Cost(ambient);
  view.ambient = ambient;
  view.map = on.objective->map();
  view.grids = setup.GridsOf(state.lobes);
  return view;
}

void AddRenders(const std::vector<BesideRender>& beside, const float* map,
                std::vector<PixelRender>* renders) {
  for (const BesideRender& render : beside) {
    renders->push_back({render.brdfs, map, render.radiance});
  }
}

// Radiance and likelihood of the views at every pixel, and what is rendered
// beside the last.
void RenderViews(const SolveSetup& setup, const Estimate& estimate,
                 const std::vector<View*>& views,
                 const std::vector<BesideRender>& beside) {
  std::vector<PixelRender> renders;
  for (View* const view : views) {
    renders.push_back(
        {ByMaterial(view->grids), view->map.data(), &view->radiance});
  }
  AddRenders(beside, views.back()->map.data(), &renders);
  RenderPixels(setup, SizeOf(estimate.iterate.light, setup), renders);
  for (View* const view : views) {
    const LikelihoodValue value = EvaluateLikelihood(
        view->radiance, setup.pixels.observed,
        LikelihoodOf(setup, estimate.iterate.scale, view->ambient), nullptr);
    view->cost.likelihood = value.cost;
    view->cost.misfit = value.misfit;
  }
}

// The reference in the estimate's place, without what speaks of the estimate
// that was turned down.
void TurnDown(Estimate* estimate) {
  estimate->iterate.state = estimate->reference.state;
  estimate->iterate.ambient = estimate->reference.ambient;
  ReflectanceEstimate turned_down = std::move(estimate->reflectance);
  estimate->reflectance = ReflectanceEstimate();
  estimate->reflectance.initial_guess = std::move(turned_down.initial_guess);
  estimate->reflectance.initial_lobes = std::move(turned_down.initial_lobes);
}

// A guess that leaves nothing but rounding is an answer: a constant map
// explains one pixel. An epsilon above the radiance hides whether it does.
bool IsExplained(const SolveSetup& setup, double misfit) {
  return misfit < kMisfitOfRounding &&
         setup.epsilon < MeanRadiance(setup.pixels.observed);
}

Image RenderOf(const View& view, const SolveSetup& setup) {
  std::vector<double> radiance = view.radiance;
  for (size_t i = 0; i < radiance.size(); ++i) {
    radiance[i] += view.ambient[i % 3];
  }
  return AtPixels(setup, radiance);
}

// The candidates, the best first, with their distances from the estimate.
std::vector<Alternative> AlternativesOf(
    const std::vector<MaterialCandidate>& candidates,
    const LobeDistance& distance, const std::vector<double>& lobes) {
  std::vector<Alternative> alternatives;
  if (candidates.empty()) return alternatives;
  const std::vector<double> found = distance.LogValues(lobes);
  const std::vector<double> best =
      distance.LogValues(candidates.front().parameters);
  for (const MaterialCandidate& candidate : candidates) {
    Alternative a;
    a.start = candidate.name;
    a.lobe_parameters = candidate.parameters;
    a.cost = candidate.cost - candidates.front().cost;
    const std::vector<double> values = distance.LogValues(candidate.parameters);
    a.brdf_log_difference = distance.Aligned(values, found);
    a.difference_from_best = distance.Aligned(values, best);
    if (std::isfinite(a.brdf_log_difference)) alternatives.push_back(a);
  }
  return alternatives;
}

}  // namespace

double PredictSummarySeconds(const SolveSetup& setup,
                             const SolveContext& context) {
  const std::vector<ShadingPoint>& points = setup.pixels.points;
  const size_t stride = std::max<size_t>(points.size() / kProbePoints, 1);
  Observation probe;
  for (size_t i = 0; i < points.size(); i += stride) {
    probe.points.push_back(points[i]);
  }
  const size_t probed = probe.points.size();
  const double start = context.Elapsed();
  ObservedPixels(setup, std::move(probe)).TransportFrom(setup.map_size());
  // Each transport has one of the radiosity patches besides.
  const auto& patches = setup.transport.patches;
  const size_t besides = patches ? patches->points().size() : 0;
  const double transport = (context.Elapsed() - start) *
                           static_cast<double>(points.size() + besides) /
                           static_cast<double>(probed + besides);
  const double seconds =
      std::min(kSummaryPerTransport * transport +
                   (setup.lobes_unknown() ? kTableSeconds : 0.0) +
                   setup.problem->seconds_reserved,
               kMostSummaryShare * std::max(context.budget() - start, 0.0));
  VLOG(1) << "the summary is predicted to take " << seconds << " s";
  return seconds;
}

double SpreadOf(const SolveSetup& setup, const std::vector<double>& lobes,
                const ReflectanceEstimate& reflectance) {
  const InverseProblem& problem = *setup.problem;
  const Eigen::MatrixXd& covariance = reflectance.covariance;
  if (covariance.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  const LobeDistance distance(FlowLobes::Factory(
      *problem.model, setup.lobes->layout(), problem.num_threads));
  const auto spread =
      setup.light_unknown() ? ReflectanceSpread : KnownLightSpread;
  return std::hypot(
      spread(distance, lobes,
             {covariance.data(), covariance.data() + covariance.size()},
             kSpreadSamples, problem.seed),
      reflectance.between_optima);
}

MaterialSolution SummariseReflectance(const SolveSetup& setup,
                                      const std::vector<double>& lobes,
                                      const ReflectanceEstimate& reflectance) {
  const InverseProblem& problem = *setup.problem;
  const Eigen::MatrixXd& covariance = reflectance.covariance;
  MaterialSolution out;
  out.lobe_parameters = lobes;
  out.brdf = setup.lobes->ToMerl(lobes.data());
  out.lobe_covariance.assign(covariance.data(),
                             covariance.data() + covariance.size());
  const LobeFactory factory = FlowLobes::Factory(
      *problem.model, setup.lobes->layout(), problem.num_threads);
  const LobeDistance distance(factory);
  out.determined =
      FindDeterminedDirections(setup.materials, out.lobe_covariance);
  out.ranking = reflectance.ranking;
  if (covariance.size() > 0) {
    const LobeDistance level(factory, kLevelGrid);
    out.slices =
        ReflectanceBand(factory, lobes, out.lobe_covariance, kBandSamples,
                        problem.seed, setup.light_unknown() ? &level : nullptr);
  }
  out.structured_misfit = reflectance.structured_misfit;
  // How spreads stand to errors was measured where the light is unknown, and of
  // one material under a known one.
  if (setup.light_unknown() || std::isfinite(out.structured_misfit)) {
    out.spread = SpreadOf(setup, lobes, reflectance);
  }
  out.alternatives = AlternativesOf(reflectance.candidates, distance, lobes);
  out.start = reflectance.initial_guess;
  return out;
}

Solution Summarise(const SolveSetup& setup, Estimate estimate,
                   SolveContext* context,
                   const std::vector<BesideRender>& beside) {
  const InverseProblem& problem = *setup.problem;
  const int num_pixels = setup.pixels.observed.num_valid;
  const double scale = estimate.iterate.scale;
  const Reference& reference = estimate.reference;
  View first = ViewOf(reference.state, reference.priors, reference.ambient,
                      setup, estimate);
  View last = ViewOf(estimate.iterate.state, estimate.iterate.light.priors,
                     estimate.iterate.ambient, setup, estimate);
  RenderViews(setup, estimate, {&first, &last}, beside);
  const TraceEntry start = MakeEntry("start", setup, *context, num_pixels,
                                     scale, reference.state, first.cost);
  TraceEntry end = MakeEntry("end", setup, *context, num_pixels, scale,
                             estimate.iterate.state, last.cost);
  Solution solution;
  if (!(end.cost < start.cost)) {
    TurnDown(&estimate);
    last = std::move(first);
    end = start;
    end.stage = "end";
    std::vector<PixelRender> again;
    AddRenders(beside, last.map.data(), &again);
    RenderPixels(setup, SizeOf(estimate.iterate.light, setup), again);
    if (!IsExplained(setup, start.misfit)) {
      solution.status =
          Status(StatusCode::kNoImprovement,
                 "the solver could not improve on its initial guess");
    }
  }
  if (context->Interrupted()) {
    solution.status = Status(StatusCode::kInterrupted,
                             "interrupted; the best iterate was kept");
  }
  context->Report(end);
  solution.map = Image(problem.map_width, problem.map_height);
  solution.map.rgb = setup.light_unknown() ? last.map : problem.known_map->rgb;
  solution.render = RenderOf(last, setup);
  solution.ambient = last.ambient;
  if (setup.lobes_unknown()) {
    solution.reflectance() = SummariseReflectance(
        setup, estimate.iterate.state.lobes, estimate.reflectance);
  }
  solution.light_hyperparameters = estimate.reflectance.light.hyperparameters;
  solution.directional_lights = estimate.reflectance.light.directional_lights;
  solution.map_std = estimate.reflectance.light.log_std;
  solution.map_variance_left = estimate.reflectance.light.variance_left;
  solution.map_variance_left_by_degree =
      estimate.reflectance.light.variance_left_by_degree;
  solution.scale = scale;
  solution.epsilon = setup.epsilon;
  solution.misfit = end.misfit;
  solution.start_cost = start.cost;
  solution.end_cost = end.cost;
  solution.pixels_used = num_pixels;
  solution.start = estimate.reflectance.initial_guess;
  solution.trace = context->trace();
  solution.seconds = context->Elapsed();
  return solution;
}

}  // namespace ibrdf
