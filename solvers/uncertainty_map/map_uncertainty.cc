#include "ibrdf/solvers/uncertainty_map/map_uncertainty.h"

#include <utility>

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/solvers/next_view/candidate_views.h"

namespace ibrdf {
namespace {

StatusOr<TexelObserver> ObserverOf(const Problem& problem,
                                   const UncertaintyInputs& inputs,
                                   int num_threads) {
  std::vector<ObservedView> views;
  for (const PhotographedView& view : inputs.views) {
    views.push_back({view.camera, view.radiance, view.mask});
  }
  ObserverOptions options;
  options.shadowed_light =
      problem.uncertainty.shadows == EntropyShadows::kMirror;
  options.num_threads = num_threads;
  StatusOr<TexelObserver> observer =
      TexelObserver::Make(inputs.surface.scene, inputs.surface.atlas,
                          std::move(views), inputs.prefiltered, options);
  if (!observer.ok()) {
    return InvalidInput(problem.path, observer.status().message());
  }
  return observer;
}

Status CheckSighted(const Problem& problem, const TexelEntropy& texels,
                    UncertaintyInputs* inputs) {
  if (texels.CountObserved() == 0) {
    return InvalidInput(
        problem.path + ": views",
        "expected one that sees the surface: none has a sample of any of " +
            std::to_string(texels.observed_views.size()) + " texels");
  }
  for (size_t k = 0; k < inputs->views.size(); ++k) {
    if (texels.texels_of_view[k] > 0) continue;
    inputs->warnings.push_back("view " + inputs->views[k].name +
                               " sees none of the surface");
  }
  return OkStatus();
}

}  // namespace

StatusOr<UncertaintyResult> MapUncertainty(const Problem& problem,
                                           const UncertaintyOptions& options) {
  UncertaintyResult result;
  const Stopwatch watch;
  double begun = 0.0;
  const auto end_stage = [&](const char* stage) {
    const double now = watch.Seconds();
    result.stages.push_back({stage, now - begun});
    begun = now;
  };
  StatusOr<UncertaintyInputs> inputs =
      LoadUncertaintyInputs(problem, options.num_threads);
  if (!inputs.ok()) return inputs.status();
  std::vector<CalibratedView> candidates;
  if (options.add > 0) {
    StatusOr<std::vector<CalibratedView>> loaded = LoadCandidates(
        options.candidates, SettingOf(*inputs), problem.geometry.up);
    if (!loaded.ok()) return loaded.status();
    candidates = *std::move(loaded);
  }
  end_stage("read");

  const StatusOr<TexelObserver> observer =
      ObserverOf(problem, *inputs, options.num_threads);
  if (!observer.ok()) return observer.status();
  end_stage("find_samples");

  StatusOr<TexelEntropy> texels = EvaluateTexels(
      *observer,
      {inputs->mean_radiance, inputs->prefilter_alpha,
       inputs->irradiance.get()},
      problem.uncertainty, options.num_threads, options.progress);
  if (!texels.ok()) return texels.status();
  IBRDF_RETURN_IF_ERROR(CheckSighted(problem, *texels, &*inputs));
  end_stage("evaluate");

  if (options.add > 0) {
    StatusOr<NextViews> next = ChooseNextViews(
        *inputs, *observer, problem.uncertainty, std::move(candidates),
        {options.add, options.num_threads});
    if (!next.ok()) return next.status();
    result.next = *std::move(next);
    end_stage("next_views");
  }
  result.inputs = *std::move(inputs);
  result.texels = *std::move(texels);
  return result;
}

}  // namespace ibrdf
