#include "ibrdf/solvers/estimation/light_given_reflectance.h"

#include <functional>
#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/outer_iterations.h"
#include "ibrdf/solvers/illumination/log_map_fit.h"
#include "ibrdf/solvers/illumination/process_illumination.h"

namespace ibrdf {
namespace {

// Shares of the time that remains, at most: the MAP estimate under the Gaussian
// process; the last stage, whose last steps take the rest.
constexpr double kProcessShare = 0.5;
constexpr double kMapShare = 0.9;
// The network is dropped above this multiple of the MAP estimate's misfit: the
// latter is the smoother of the two where the image tells nothing and has the
// finer detail where it does.
constexpr double kWorseMisfit = 1.02;
// Finer bins are taken where binning leaves out more than this share of the
// misfit.
constexpr double kBlurredShare = 0.2;
// Iterations of a map, at most, before the reflectance is revised, each time. A
// map that is finished is as sharp as the wrong reflectance asks for.
constexpr int kBeforeRevision = 4;
// Iterations by Gauss-Newton under a known reflectance: their steps come near
// their limits, and later ones changed no map's error (docs/notes/
// preconditioned_maps.md).
constexpr int kMapIterations = 2;
// Maps are first found at this size or below, where their sides halve; in no
// case at a larger one than a process's (ProcessSize).
constexpr int kProcessWidth = 128;

bool IsFree(const SolveSetup& setup) {
  return setup.problem->illumination_prior == IlluminationPrior::kNone;
}

// A map's size for the process, its sides halved, where they can be, until it
// is no wider than that.
MapSize HalvedSize(MapSize size, int most_width) {
  while (size.width > most_width && size.width % 4 == 0 &&
         size.height % 2 == 0) {
    size.width /= 2;
    size.height /= 2;
  }
  return ProcessSize(size);
}

Estimate Begin(const SolveSetup& setup, ReflectanceEstimate reflectance) {
  Estimate estimate;
  estimate.iterate.state.lobes = reflectance.lobes;
  estimate.iterate.scale = setup.initial_scale;
  estimate.reflectance = std::move(reflectance);
  estimate.pixels = std::make_unique<ObservedPixels>(setup, setup.binned);
  return estimate;
}

void Report(const std::string& stage, const SolveSetup& setup,
            const Estimate& estimate, SolveContext* context) {
  context->Report(Evaluate(stage, setup, *context, estimate.iterate,
                           estimate.pixels.get()));
}

// Whether the map at hand makes light that binned pixels cannot show.
bool BinsBlur(const SolveSetup& setup, const SolveContext& context,
              const Estimate& estimate) {
  // Points in shadow are not binned. And what pixels tell beyond bins of an
  // estimated reflectance is as much its errors as the map.
  if (setup.transport.visibility != nullptr || !setup.reflectance_known()) {
    return false;
  }
  if (context.StopAfter(1.0)()) return false;
  // A dense method was found to take the coarser bins.
  if (MethodFor(setup.problem->solver, JointBlocks::kLight) ==
      JointMethod::kTrustRegion) {
    return false;
  }
  const int bins_across = setup.MapBins(kMapBins);
  ObservationPair pair =
      MakePair(setup.pixels, setup.problem->image.width, bins_across);
  if (pair.bins.observed.num_valid == 0) return false;
  const Iterate& iterate = estimate.iterate;
  const auto radiance = [&](const Observation& observation) {
    ObservedPixels pixels(setup, observation);
    const PosteriorObjective on = ObjectiveOn(
        &pixels, setup, iterate.light, iterate.light.priors, iterate.scale);
    on.objective->Evaluate(iterate.state);
    return on.objective->radiance();
  };
  const double error = BinningError(pair.pixels, radiance(pair.pixels),
                                    radiance(pair.bins), bins_across);
  return error > kBlurredShare * Evaluate("map", setup, context, iterate,
                                          estimate.pixels.get())
                                     .misfit;
}

OuterIterationOptions MapOptions(JointMethod method, double share) {
  OuterIterationOptions options;
  options.stage = "map";
  options.method = method;
  options.share = share;
  return options;
}

// The map from binned pixels, and from finer bins where those tell more.
Status IterateMap(OuterIterationOptions options, const SolveSetup& setup,
                  SolveContext* context, Estimate* estimate) {
  IBRDF_RETURN_IF_ERROR(RunOuterIterations(options, setup,
                                           estimate->pixels.get(), context,
                                           &estimate->iterate)
                            .status());
  if (!BinsBlur(setup, *context, *estimate)) return OkStatus();
  *estimate->pixels = ObservedPixels(
      setup, MeansByNormal(setup.pixels, setup.MapBins(kFineMapBins)));
  options.stage = "fine map";
  options.first = 1;
  return RunOuterIterations(options, setup, estimate->pixels.get(), context,
                            &estimate->iterate)
      .status();
}

// A map of the Gaussian process, constant at the level that the lobes ask for.
void BeginProcessMap(const SolveSetup& setup, MapSize size,
                     Estimate* estimate) {
  const LightPosterior& posterior = estimate->reflectance.light;
  BeginLight(MakeLightModel(
                 MakeProcessIllumination(
                     size.width, size.height, LightProcess(),
                     posterior.hyperparameters, posterior.directional_lights),
                 false),
             setup, estimate);
  SetReference(setup, estimate);
}

// It takes far less than an iteration, and where no time is left for one this
// is the map at hand.
void FitMap(const LogMap& log_map, SolveContext* context, Estimate* estimate) {
  LogMapFitOptions o;
  o.should_stop = [context] { return context->Interrupted(); };
  FitLogMap(log_map, o, estimate->iterate.light.map.get(),
            &estimate->iterate.state.light);
}

// The map becomes the search's, where there is one.
void FitSearchedMap(SolveContext* context, Estimate* estimate) {
  const LogMap& mode = estimate->reflectance.light.mode;
  if (mode.num_texels() == 0) return;
  FitMap(mode.Resized(estimate->iterate.light.map->size()), context, estimate);
}

// The estimate's lobes become others, under its map of the Gaussian process.
void TakeRevision(RevisedReflectance revised, const SolveSetup& setup,
                  SolveContext* context, Estimate* estimate) {
  estimate->reflectance.lobes = revised.lobes;
  if (revised.light.has_value()) {
    estimate->reflectance.light = *std::move(revised.light);
  }
  if (!revised.initial_guess.empty()) {
    estimate->reflectance.initial_guess = std::move(revised.initial_guess);
    estimate->reflectance.initial_lobes = std::move(revised.initial_lobes);
  }
  estimate->iterate.state.lobes = std::move(revised.lobes);
  estimate->iterate.scale = setup.initial_scale;
  BeginProcessMap(setup, revised.log_map.size(), estimate);
  FitMap(revised.log_map, context, estimate);
}

// Iterations of a map and revisions of the reflectance, up to the last of
// these. Returns whether more iterations would gain more; options->first is the
// number of the next one.
StatusOr<bool> ReviseAlong(const ReviseReflectance& revise,
                           const SolveSetup& setup, SolveContext* context,
                           Estimate* estimate, OuterIterationOptions* options) {
  OuterIterationOptions some = *options;
  for (some.last = kBeforeRevision;; some.last += kBeforeRevision) {
    const StatusOr<bool> unsettled = RunOuterIterations(
        some, setup, estimate->pixels.get(), context, &estimate->iterate);
    if (!unsettled.ok()) return unsettled.status();
    StatusOr<std::optional<RevisedReflectance>> revised = revise(*estimate);
    if (!revised.ok()) return revised.status();
    some.first = some.last + 1;
    options->first = some.first;
    if (!revised->has_value()) return unsettled;
    TakeRevision(**std::move(revised), setup, context, estimate);
  }
}

// The MAP estimate under the Gaussian process, whose parameters are as good as
// whitened and take a tenth of the time of a network's.
Status EstimateProcessMap(const SolveSetup& setup, MapSize size,
                          OuterIterationOptions options,
                          const ReviseReflectance& revise,
                          SolveContext* context, Estimate* estimate) {
  BeginProcessMap(setup, size, estimate);
  Report("constant map", setup, *estimate, context);
  FitSearchedMap(context, estimate);
  if (setup.reflectance_known() &&
      options.method == JointMethod::kGaussNewton) {
    options.last = kMapIterations;
  }
  // Adam's few first steps make no map.
  if (revise && options.method != JointMethod::kAdam) {
    const StatusOr<bool> unsettled =
        ReviseAlong(revise, setup, context, estimate, &options);
    if (!unsettled.ok() || !*unsettled) return unsettled.status();
  }
  return IterateMap(options, setup, context, estimate);
}

// The map as the network's output, fitted first to the MAP estimate at hand,
// which is kept where the network does not explain the image as well.
Status EstimateNetworkMap(const SolveSetup& setup, SolveContext* context,
                          Estimate* estimate) {
  Iterate* const iterate = &estimate->iterate;
  ObservedPixels* const pixels = estimate->pixels.get();
  const double process_misfit =
      Evaluate("map", setup, *context, *iterate, pixels).misfit;
  const LogMap log_map = LogMapOf(*iterate);
  const std::vector<float> process_parameters = iterate->state.light;
  std::unique_ptr<IlluminationModel> process = std::move(iterate->light.map);

  BeginLightAtLevel(MakeLightModel(MakeIllumination(*setup.problem), true),
                    estimate);
  SetReference(setup, estimate);
  const MapSize size = SizeOf(iterate->light, setup);
  LogMapFitOptions o;
  o.should_stop = context->StopAfter(kMapShare / 2);
  FitLogMap(log_map.Resized(size), o, iterate->light.map.get(),
            &iterate->state.light);
  Report("network", setup, *estimate, context);
  OuterIterationOptions options;
  options.stage = "network";
  options.method = MethodFor(setup.problem->solver, JointBlocks::kLight);
  options.share = kMapShare;
  // A MAP estimate of another size is no map to fall back on.
  options.most_misfit =
      log_map.size() == size ? kWorseMisfit * process_misfit : 0.0;
  IBRDF_RETURN_IF_ERROR(
      RunOuterIterations(options, setup, pixels, context, iterate).status());
  const double misfit =
      Evaluate("network", setup, *context, *iterate, pixels).misfit;
  if (options.most_misfit > 0.0 && misfit > options.most_misfit) {
    BeginLightAtLevel(MakeLightModel(std::move(process), false), estimate);
    SetReference(setup, estimate);
    iterate->state.light = process_parameters;
    Report("map: Gaussian process kept", setup, *estimate, context);
  }
  return OkStatus();
}

Status EstimateByProcessAndNetwork(const SolveSetup& setup,
                                   const ReviseReflectance& revise,
                                   SolveContext* context, Estimate* estimate) {
  // solver.method is the network's.
  const JointMethod method = JointMethod::kGaussNewton;
  const MapSize size = HalvedSize(setup.map_size(), kProcessWidth);
  const std::function<bool()> cut_short = context->StopAfter(kProcessShare);
  IBRDF_RETURN_IF_ERROR(EstimateProcessMap(setup, size,
                                           MapOptions(method, kProcessShare),
                                           revise, context, estimate));
  if (cut_short() && size == setup.map_size()) {
    // What time is left serves the MAP estimate better than a network.
    return IterateMap(MapOptions(method, kMapShare), setup, context, estimate);
  }
  return EstimateNetworkMap(setup, context, estimate);
}

// The map of the problem's own parameterisation from a constant one, without a
// MAP estimate before it.
Status EstimateDirectly(const SolveSetup& setup, JointMethod method,
                        SolveContext* context, Estimate* estimate) {
  BeginLight(MakeLightModel(MakeIllumination(*setup.problem), !IsFree(setup)),
             setup, estimate);
  SetReference(setup, estimate);
  Report("constant map", setup, *estimate, context);
  return IterateMap(MapOptions(method, kMapShare), setup, context, estimate);
}

}  // namespace

StatusOr<Estimate> EstimateLight(const SolveSetup& setup,
                                 ReflectanceEstimate reflectance,
                                 SolveContext* context,
                                 const ReviseReflectance& revise) {
  const InverseProblem& problem = *setup.problem;
  const JointMethod method = MethodFor(problem.solver, JointBlocks::kLight);
  Estimate estimate = Begin(setup, std::move(reflectance));
  Status status;
  if (IsFree(setup) || problem.solver.max_iterations == 0) {
    status = EstimateDirectly(setup, method, context, &estimate);
  } else if (problem.illumination_prior == IlluminationPrior::kProcess) {
    status = EstimateProcessMap(setup, setup.map_size(),
                                MapOptions(method, kMapShare), revise, context,
                                &estimate);
  } else {
    status = EstimateByProcessAndNetwork(setup, revise, context, &estimate);
  }
  if (!status.ok()) return status;
  return estimate;
}

StatusOr<Estimate> EstimateProcessLight(const SolveSetup& setup,
                                        ReflectanceEstimate reflectance,
                                        int most_width, SolveContext* context) {
  Estimate estimate = Begin(setup, std::move(reflectance));
  BeginProcessMap(setup, HalvedSize(setup.map_size(), most_width), &estimate);
  FitSearchedMap(context, &estimate);
  OuterIterationOptions options = MapOptions(JointMethod::kGaussNewton, 1.0);
  options.last = kMapIterations;
  IBRDF_RETURN_IF_ERROR(RunOuterIterations(options, setup,
                                           estimate.pixels.get(), context,
                                           &estimate.iterate)
                            .status());
  return estimate;
}

Estimate ConstantLight(const SolveSetup& setup,
                       ReflectanceEstimate reflectance) {
  Estimate estimate = Begin(setup, std::move(reflectance));
  BeginLight(MakeLightModel(MakeIllumination(*setup.problem), !IsFree(setup)),
             setup, &estimate);
  SetReference(setup, &estimate);
  return estimate;
}

}  // namespace ibrdf
