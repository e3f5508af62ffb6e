#include "ibrdf/solvers/published/joint_maximum.h"

#include <memory>
#include <utility>

#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/outer_iterations.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"

namespace ibrdf {
namespace {

// The share of the time that remains; the last steps take the rest.
constexpr double kShare = 0.9;

// The mean material, at the scale that the priors prefer, under a constant map.
Estimate InitialGuess(const SolveSetup& setup) {
  Estimate estimate;
  estimate.reflectance = MeanMaterial(setup);
  estimate.iterate.scale = setup.initial_scale;
  estimate.pixels = std::make_unique<ObservedPixels>(setup, setup.binned);
  JointState* const state = &estimate.iterate.state;
  state->lobes = estimate.reflectance.lobes;
  BeginLight(MakeLightModel(MakeIllumination(*setup.problem), true), setup,
             &estimate);
  SettleScale(setup, &estimate.iterate);
  estimate.reflectance.initial_lobes = state->lobes;
  BeginLight(std::move(estimate.iterate.light), setup, &estimate);
  SetReference(setup, &estimate);
  return estimate;
}

}  // namespace

StatusOr<Estimate> EstimateJointMaximum(const SolveSetup& setup,
                                        SolveContext* context) {
  Estimate estimate = InitialGuess(setup);
  context->Report(Evaluate("initial guess", setup, *context, estimate.iterate,
                           estimate.pixels.get()));
  OuterIterationOptions options;
  options.stage = "maximum";
  options.method = MethodFor(setup.problem->solver, JointBlocks::kBoth);
  options.blocks = JointBlocks::kBoth;
  options.share = kShare;
  IBRDF_RETURN_IF_ERROR(RunOuterIterations(options, setup,
                                           estimate.pixels.get(), context,
                                           &estimate.iterate)
                            .status());
  return estimate;
}

}  // namespace ibrdf
