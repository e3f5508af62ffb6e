#include "ibrdf/solvers/estimation/marginal_search.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/median.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/table_lobes.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/priors/embedding_prior.h"
#include "ibrdf/solvers/problem/quadrature_level.h"

namespace ibrdf {
namespace {

// Shares of the time that remains, at most: the search for the reflectance, and
// for the hyperparameters of the light under a known one.
constexpr double kSearchShare = 0.55;
constexpr double kLightSearchShare = 0.25;
// Of CoarseEvidence: enough for the best few materials to come near their
// optima.
const std::vector<SearchStage> kEvidenceStages = {{4, 2}, {2, 5}};
// Below this multiple of the median radiance no camera sees, and its logarithm
// is far from all others.
constexpr double kDarkest = 1e-8;
// Where nearly all of a point's light comes from the object the map's says
// little of it.
constexpr double kMostBounceGain = 10.0;
// A painted object has these, in the priors' own: the deviations of what
// FindFirstPaint leaves of paint, and the variance of the light's chroma.
constexpr double kLeftOfPaint = 0.3;
constexpr double kPaintedLightChroma = 0.1;

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

// BounceGain of all pixels, slice by slice. The last slice's transport is kept,
// which spares a small image the making of another.
class BounceGains {
 public:
  BounceGains(const SolveSetup& setup, MapSize size)
      : setup_(setup), size_(size) {}

  // At lobes and a log radiance [3][texels] of the search; empty: not to be
  // had.
  std::vector<double> Of(const std::vector<double>& lobes,
                         const std::vector<double>& log_radiance) {
    const InverseProblem& problem = *setup_.problem;
    const size_t count = problem.points.size();
    const BrdfGrid grid = setup_.lobes_unknown()
                              ? setup_.lobes->Grid(lobes.data())
                              : *problem.known_brdf;
    std::vector<double> gain;
    for (size_t begin = 0; begin < count; begin += kPointsAtOnceWithBounces) {
      const std::vector<double> of_slice =
          BounceGain(TransportOf(begin), grid, log_radiance);
      if (of_slice.empty()) return of_slice;
      gain.insert(gain.end(), of_slice.begin(), of_slice.end());
    }
    return gain;
  }

 private:
  const Transport& TransportOf(size_t begin) {
    if (transport_ != nullptr && begin_ == begin) return *transport_;
    const std::vector<ShadingPoint>& points = setup_.problem->points;
    const size_t end =
        std::min(begin + kPointsAtOnceWithBounces, points.size());
    transport_.reset();  // the memory of one at a time
    transport_ = std::make_unique<Transport>(
        std::vector<ShadingPoint>(points.begin() + begin, points.begin() + end),
        size_.height, size_.width, setup_.transport);
    begin_ = begin;
    return *transport_;
  }

  const SolveSetup& setup_;
  const MapSize size_;
  std::unique_ptr<const Transport> transport_;
  size_t begin_ = 0;
};

// The first stages of a small budget of iterations are cut short alike.
void LimitIterations(int iterations, ReflectanceSearchOptions* options) {
  if (iterations == 0) options->coarse_stages = {{1, 0}};
  for (SearchStage& stage : options->coarse_stages) {
    stage.iterations = std::min(stage.iterations, 5 * iterations);
  }
  options->fine_iterations = std::min(options->fine_iterations, 5 * iterations);
}

// A search that spends at most a share of the time that remains.
ReflectanceSearchOptions SearchOptions(double share, const SolveSetup& setup,
                                       SolveContext* context) {
  const InverseProblem& problem = *setup.problem;
  ReflectanceSearchOptions o;
  o.num_threads = problem.num_threads;
  for (MarginalResolution* resolution : {&o.screen, &o.coarse, &o.fine}) {
    resolution->visibility = problem.transport.visibility;
    resolution->quadrature =
        AtLevel(resolution->quadrature, problem.solver.quadrature);
  }
  o.should_stop = context->StopAfter(share);
  LimitIterations(problem.solver.max_iterations, &o);
  o.report = [&setup, context](const std::string& stage, double cost,
                               double misfit) {
    TraceEntry entry;
    entry.stage = stage;
    entry.pixels = setup.pixels.observed.num_valid;
    entry.cost = entry.likelihood = cost;
    entry.misfit = misfit;
    entry.seconds = context->Elapsed();
    context->Report(entry);
  };
  if (problem.transport.patches != nullptr) {
    const auto gains = std::make_shared<BounceGains>(
        setup, MapSize{o.fine.map_width, o.fine.map_height});
    o.bounce_gain = [gains](const std::vector<double>& lobes,
                            const std::vector<double>& log_radiance) {
      return gains->Of(lobes, log_radiance);
    };
  }
  return o;
}

// The pixels with radiance 0, which a search leaves out, where it is far below
// any measurement.
Observations SearchedPixels(const SolveSetup& setup) {
  const Observations& observed = setup.pixels.observed;
  std::vector<double> radiance = observed.radiance;
  std::vector<double> lit;
  for (const double e : radiance) {
    if (std::isfinite(e) && e > 0.0) lit.push_back(e);
  }
  if (lit.empty()) return observed;
  const double darkest = kDarkest * UpperMedian(std::move(lit));
  for (double& e : radiance) {
    if (e < darkest) e = 0.0;
  }
  return MakeObservations(std::move(radiance), observed.low, observed.high);
}

// What a search says of the light, whose log radiance is to fall by `level`.
LightPosterior LightOf(const ReflectanceSearchResult& found, double level) {
  LightPosterior light;
  light.hyperparameters = found.hyperparameters;
  light.directional_lights = found.directional_lights;
  std::vector<float> mode;
  for (const double v : found.log_radiance) {
    mode.push_back(static_cast<float>(v - level));
  }
  light.mode = LogMap({found.map_width, found.map_height}, std::move(mode));
  light.log_std =
      FromPlanes(found.log_radiance_std, found.map_width, found.map_height);
  return light;
}

// Before the light is known, pixels tell paint and a lamp by themselves; what
// is left is small. Under a lamp its chroma is hardly the light's, which else
// would explain paint at no cost.
void AddPaint(const FirstPaint& first, ReflectanceSearchOptions* o) {
  if (first.light) {
    o->directional_lights = {first.light->direction};
    VLOG(1) << "a lamp of strength " << first.light->strength
            << " shades the paint; deviation at like normals "
            << first.deviation;
  }
  o->paint.emplace();
  o->paint->albedo = AlbedoPrior().Scaled(kLeftOfPaint);
  o->paint->albedo.own_luminance =
      std::max(o->paint->albedo.own_luminance, first.deviation);
  o->paint->mean = first.log_albedo;
  if (first.natural_light) return;
  o->process.chroma_variance *= kPaintedLightChroma;
  o->process.directional_light_chroma_variance *= kPaintedLightChroma;
}

}  // namespace

StatusOr<ReflectanceEstimate> EstimateReflectance(const SolveSetup& setup,
                                                  SolveContext* context,
                                                  const FirstPaint* paint) {
  const InverseProblem& problem = *setup.problem;
  ReflectanceSearchOptions o = SearchOptions(kSearchShare, setup, context);
  o.covariance = problem.solver.max_iterations > 0;
  if (paint != nullptr) AddPaint(*paint, &o);
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      FlowLobes::Factory(*problem.model, setup.lobes->layout(),
                         problem.num_threads),
      setup.materials, problem.points, SearchedPixels(setup), o);
  if (!found.ok()) return found.status();
  ReflectanceEstimate out;
  out.lobes = found->parameters;
  const LevelGauge gauge(*problem.model, setup.materials, problem.num_threads);
  out.light = LightOf(*found, gauge.Fix(out.lobes.data()));
  out.initial_guess = found->initial_guess;
  const auto& materials = setup.materials.materials;
  const auto initial = std::find_if(
      materials.begin(), materials.end(),
      [&](const auto& m) { return m.name == found->initial_guess; });
  out.initial_lobes = ToVector(initial->parameters);
  gauge.Fix(out.initial_lobes.data());
  out.covariance = found->covariance;
  for (const MaterialCandidate& candidate : found->candidates) {
    if (std::isfinite(candidate.cost)) out.candidates.push_back(candidate);
  }
  return out;
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
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance(TableLobes::Factory(*problem.known_brdf),
                        KnownMaterial(ToEigen(TableLobes::KnownParameters())),
                        problem.points, SearchedPixels(setup), o);
  return found.ok() ? LightOf(*found, 0.0) : LightPosterior();
}

double CoarseEvidence(const SolveSetup& setup, SolveContext* context,
                      const PaintPrior* paint) {
  const InverseProblem& problem = *setup.problem;
  ReflectanceSearchOptions o = SearchOptions(1.0, setup, context);
  o.coarse_stages = kEvidenceStages;
  o.fine_iterations = 0;
  o.covariance = false;
  o.bounce_gain = {};
  o.report = {};
  if (paint != nullptr) o.paint = *paint;
  const StatusOr<ReflectanceSearchResult> found =
      setup.lobes_unknown()
          ? SearchReflectance(
                FlowLobes::Factory(*problem.model, setup.lobes->layout(),
                                   problem.num_threads),
                setup.materials, problem.points, SearchedPixels(setup), o)
          : SearchReflectance(
                TableLobes::Factory(*problem.known_brdf),
                KnownMaterial(ToEigen(TableLobes::KnownParameters())),
                problem.points, SearchedPixels(setup), o);
  return found.ok() ? found->cost : std::numeric_limits<double>::infinity();
}

ReflectanceEstimate MeanMaterial(const SolveSetup& setup) {
  ReflectanceEstimate out;
  out.initial_guess = SpreadMaterials(*setup.problem->model, 1).front().name;
  for (const MaterialPrior::Material& m : setup.materials.materials) {
    if (m.name == out.initial_guess) out.lobes = ToVector(m.parameters);
  }
  out.initial_lobes = out.lobes;
  return out;
}

}  // namespace ibrdf
