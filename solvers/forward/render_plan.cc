#include "ibrdf/solvers/forward/render_plan.h"

#include <glog/logging.h>

#include <utility>

#include "ibrdf/solvers/forward/measured_effects.h"

namespace ibrdf {
namespace {

constexpr double kReferenceApproximationError = 3e-4;

// Lights the scene with all effects, as which it returns it, and measures what
// each is for. Patches do not tell what a narrow lobe shows of the object.
OmissionErrors MeasureNarrowLobe(const ForwardScene& scene,
                                 const RenderTolerances& tolerances,
                                 const SceneRadianceOptions& options,
                                 std::unique_ptr<SceneRadiance>* lit) {
  CHECK_GT(tolerances.lobe, 0.0);
  const std::vector<ShadingPoint>& points = scene.view.points;
  EffectsPlan none, all;
  all.visibility = true;
  all.bounces = kMostBounces;
  const SceneRadiance bare(scene, points, none, options);
  *lit = std::make_unique<SceneRadiance>(scene, points, all, options);
  const OmissionErrors omission = MeasureEffects(bare, points, lit->get());
  ChooseLobeRays(points, tolerances.lobe, lit->get());
  return omission;
}

// Fills effects, lobe_rays and radiance in.
Status PlanRadiance(const Problem& problem, const ForwardScene& scene,
                    int num_threads, PlannedRender* out) {
  const RenderTolerances tolerances = RenderTolerances::Of(problem.quality);
  const SceneRadianceOptions radiance =
      SceneRadianceOptions::Of(problem.quality, num_threads);
  EffectsOptions options;
  options.threshold = tolerances.omission;
  options.known_map = &scene.map;
  options.known_brdf = &scene.grid;
  options.num_threads = num_threads;
  std::unique_ptr<SceneRadiance> lit;
  if (scene.narrow_lobe && problem.quality == RenderQuality::kPreview) {
    options.measure = [&] {
      return MeasureNarrowLobe(scene, tolerances, radiance, &lit);
    };
  }
  StatusOr<EffectsPlan> effects =
      PlanEffects(problem, scene.view.scene, scene.view.points, options);
  if (!effects.ok()) return effects.status();

  if (lit != nullptr && effects->visibility) {
    lit->set_bounces(effects->bounces);
    out->radiance = std::move(lit);
  } else {
    out->radiance = std::make_unique<SceneRadiance>(scene, scene.view.points,
                                                    *effects, radiance);
  }
  out->plan.effects = *std::move(effects);
  if (scene.narrow_lobe && out->plan.effects.bounces > 0) {
    out->plan.lobe_rays = out->radiance->lobe_rays();
  }
  return OkStatus();
}

// What the points may be rendered by. A preview takes what is fast; reference
// quality only what the user asks for.
ApproximationOptions MayTake(const Problem& problem, const EffectsPlan& effects,
                             bool textured) {
  ApproximationOptions options;
  options.log_error = RenderTolerances::Of(problem.quality).approximation;
  if (effects.visibility || textured) return options;
  options.reflectance_map = effects.reflectance_map;
  const EffectsSpec& spec = problem.effects;
  if (spec.mode == EffectsMode::kAuto) {
    options.harmonics = options.gaussians =
        problem.quality == RenderQuality::kPreview;
  } else if (spec.mode == EffectsMode::kList) {
    options.harmonics = spec.Lists(Effect::kHarmonics);
    options.gaussians = spec.Lists(Effect::kGaussians);
    options.forced = options.harmonics || options.gaussians;
  }
  return options;
}

// The scene at reference quality, set up when it is asked for points: a preview
// is off by more than what is looked for under a small sun.
class SceneReference final : public RadianceRenderer {
 public:
  SceneReference(const ForwardScene& scene, const EffectsPlan& effects,
                 int num_threads)
      : scene_(scene), effects_(effects), num_threads_(num_threads) {}

  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const override {
    return SceneRadiance(scene_, points, effects_,
                         SceneRadianceOptions::Of(RenderQuality::kReference,
                                                  num_threads_))
        .Render(points, progress, L_o);
  }

 private:
  const ForwardScene& scene_;
  const EffectsPlan& effects_;
  const int num_threads_;
};

// Fills the approximation in. False: interrupted.
bool PlanApproximation(const Problem& problem, const ForwardScene& scene,
                       int num_threads, PlannedRender* out) {
  const EffectsPlan& effects = out->plan.effects;
  const SceneReference reference(scene, effects, num_threads);
  out->approximation =
      std::make_unique<ApproximateRadiance>(scene.map, scene.brdf, num_threads);
  if (!out->approximation->Choose(
          scene.view.points, *out->radiance, reference,
          MayTake(problem, effects, scene.texture.has_value()))) {
    return false;
  }
  out->plan.approximation = out->approximation->plan();
  return true;
}

}  // namespace

RenderTolerances RenderTolerances::Of(RenderQuality quality) {
  RenderTolerances tolerances;
  if (quality == RenderQuality::kPreview) return tolerances;
  tolerances.omission = kReferenceOmissionError;
  tolerances.approximation = kReferenceApproximationError;
  return tolerances;
}

const RadianceRenderer& PlannedRender::renderer() const {
  const RadianceRenderer* approximate = approximation->renderer();
  return approximate != nullptr ? *approximate : *radiance;
}

StatusOr<PlannedRender> PlanRender(const Problem& problem,
                                   const ForwardScene& scene, int num_threads) {
  PlannedRender out;
  IBRDF_RETURN_IF_ERROR(PlanRadiance(problem, scene, num_threads, &out));
  if (!PlanApproximation(problem, scene, num_threads, &out)) {
    return RenderInterrupted(problem);
  }
  return out;
}

}  // namespace ibrdf
