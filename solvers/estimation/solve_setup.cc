#include "ibrdf/solvers/estimation/solve_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/view_bins.h"
#include "ibrdf/solvers/priors/embedding_prior.h"
#include "ibrdf/transport/bright_texels.h"

namespace ibrdf {
namespace {

constexpr double kInitialScale = 0.1;   // tolerant: scale continuation begins
constexpr double kEpsilonShare = 1e-5;  // of the mean radiance

// The spacing of directions that stand for a bright texel: finer than the
// narrowest lobes.
constexpr double kBrightSpacing = 0.75 * kPi / 180.0;
int BrightSamplesPerSide(int map_height) {
  const double texel = kPi / map_height;
  return 2 * static_cast<int>(std::ceil(texel / kBrightSpacing));
}

bool AnyHasTwoEnds(const Observations& observed) {
  for (size_t i = 0; i < observed.radiance.size(); ++i) {
    if (observed.valid[i / 3] && !observed.Interval(i).IsOneSided()) {
      return true;
    }
  }
  return false;
}

// Pixels that the known light does not reach are missing.
void LeaveOut(const std::vector<char>& unlit, Observation* pixels) {
  if (unlit.empty()) return;
  std::vector<double> radiance = pixels->observed.radiance;
  for (size_t i = 0; i < pixels->points.size(); ++i) {
    if (unlit[pixels->points[i].pixel] == 0) continue;
    std::fill_n(&radiance[3 * i], 3, std::numeric_limits<double>::quiet_NaN());
  }
  pixels->observed =
      MakeObservations(std::move(radiance), std::move(pixels->observed.low),
                       std::move(pixels->observed.high));
}

void SetKnownLight(const Image& map, SolveSetup* setup) {
  BrightTexels split = SplitBrightTexels(map);
  setup->known_map = std::move(split.rest.rgb);
  setup->transport.bright = SampleBrightTexels(
      split.texels, map.height, map.width, BrightSamplesPerSide(map.height));
}

void SetUnknownLobes(const InverseProblem& problem, SolveSetup* setup) {
  const bool published = setup->light_unknown() &&
                         problem.solver.estimator == SolverEstimator::kMaximum;
  // The published estimate has lobes of the flow alone.
  const LobeLayout layout =
      published ? LobeLayout{problem.lobes, problem.model->shape.code_size()}
                : FittedLayout(*problem.model, problem.lobes);
  setup->lobes = std::make_unique<FlowLobes>(
      *problem.model, layout, problem.transport.grid, problem.num_threads);
  setup->lobe_prior = EmbeddingPrior(*problem.model, problem.prior_sigma);
  setup->materials =
      JointMaterialPrior(*problem.model, layout, problem.prior_sigma);
}

}  // namespace

int SolveSetup::MapBins(int of_one) const {
  return BinsAcrossView(of_one, problem->sheet.views.size());
}

bool SolveSetup::joint_maximum() const {
  return lobes_unknown() && light_unknown() &&
         problem->solver.estimator == SolverEstimator::kMaximum;
}

std::vector<BrdfGrid> SolveSetup::GridsOf(
    const std::vector<double>& parameters) const {
  if (!problem->estimated_brdfs.empty()) return problem->estimated_brdfs;
  if (!lobes_unknown()) return {*problem->known_brdf};
  std::vector<BrdfGrid> grids;
  const size_t size = lobes->num_parameters();
  for (size_t first = 0; first < parameters.size(); first += size) {
    grids.push_back(lobes->Grid(&parameters[first]));
  }
  return grids;
}

StatusOr<SolveSetup> SetUp(const InverseProblem& problem) {
  SolveSetup setup;
  setup.problem = &problem;
  setup.pixels =
      Observe(problem.image, problem.bounds ? &*problem.bounds : nullptr,
              problem.points);
  LeaveOut(problem.dark.unlit, &setup.pixels);
  setup.ambient = {problem.dark.ambient, problem.dark.ambient_deviation};
  if (setup.pixels.observed.num_valid == 0) {
    return InvalidInput("image",
                        "no pixel of the object is finite and positive in "
                        "all three channels" +
                            std::string(problem.dark.unlit.empty()
                                            ? ""
                                            : " and lit by the known light"));
  }
  if (!AnyHasTwoEnds(setup.pixels.observed)) {
    if (problem.dark.num_below_floor > 0) {
      return InvalidInput(
          "illumination.known",
          "expected a light that the image shows, but the pixels that it "
          "reaches are no brighter than those in its shadow differ: is it the "
          "light's direction and frame?");
    }
    return InvalidInput("image",
                        "every value of the object is clipped or black: the "
                        "radiance of none is known from both sides");
  }
  setup.epsilon = problem.epsilon.value_or(kEpsilonShare *
                                           MeanRadiance(setup.pixels.observed));
  setup.initial_scale = problem.scale.value_or(kInitialScale);
  setup.transport = problem.transport;
  setup.transport.num_threads = problem.num_threads;
  if (problem.known_map.has_value()) {
    SetKnownLight(*problem.known_map, &setup);
  } else {
    setup.binned = problem.transport.visibility != nullptr
                       ? Thin(setup.pixels, problem.image.width)
                       : MeansByNormal(setup.pixels, setup.MapBins(kMapBins));
  }
  if (!problem.known_brdf.has_value()) SetUnknownLobes(problem, &setup);
  return setup;
}

JointMethod MethodFor(const SolverSpec& solver, JointBlocks blocks) {
  switch (solver.method) {
    case SolverMethod::kAuto:
      break;
    case SolverMethod::kAlternating:
      return JointMethod::kAlternating;
    case SolverMethod::kGaussNewton:
      return JointMethod::kGaussNewton;
    case SolverMethod::kLbfgs:
      return JointMethod::kLbfgs;
    case SolverMethod::kAdam:
      return JointMethod::kAdam;
    case SolverMethod::kTrustRegion:
      return JointMethod::kTrustRegion;
  }
  return blocks == JointBlocks::kLight ? JointMethod::kGaussNewton
                                       : JointMethod::kAlternating;
}

std::unique_ptr<IlluminationModel> MakeIllumination(
    const InverseProblem& problem) {
  if (problem.illumination_prior == IlluminationPrior::kNone) {
    return MakeFreeIllumination(problem.map_width, problem.map_height);
  }
  IlluminationUnetOptions unet;
  unet.width = problem.map_width;
  unet.height = problem.map_height;
  unet.channels = problem.unet_channels;
  unet.seed = problem.seed;
  unet.num_threads = problem.num_threads;
  return MakeUnetIllumination(unet);
}

Status CheckMethod(const SolveSetup& setup) {
  const InverseProblem& problem = *setup.problem;
  const JointMethod method = MethodFor(problem.solver, JointBlocks::kLight);
  if (!setup.light_unknown() || problem.solver.max_iterations == 0 ||
      method != JointMethod::kTrustRegion) {
    return OkStatus();
  }
  const bool process =
      problem.illumination_prior == IlluminationPrior::kProcess &&
      !setup.joint_maximum();
  const int64_t texels = int64_t{problem.map_width} * problem.map_height;
  const int64_t light =
      process ? 3 * texels : MakeIllumination(problem)->num_parameters();
  const int64_t lobes =
      setup.joint_maximum() ? setup.lobes->num_parameters() : 0;
  return CheckJointMethod(method, light + lobes,
                          static_cast<int64_t>(3 * setup.binned.points.size()));
}

ObservedPixels::ObservedPixels(const SolveSetup& setup, Observation observation)
    : options_(&setup.transport), observation_(std::move(observation)) {}

const Transport& ObservedPixels::TransportFrom(MapSize size) {
  if (transport_ == nullptr || transport_->map_height() != size.height ||
      transport_->map_width() != size.width) {
    transport_ = std::make_unique<Transport>(points(), size.height, size.width,
                                             *options_);
  }
  return *transport_;
}

}  // namespace ibrdf
