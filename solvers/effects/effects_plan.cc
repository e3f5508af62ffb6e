#include "ibrdf/solvers/effects/effects_plan.h"

#include <algorithm>

#include "ibrdf/base/format.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/light/procedural_sky.h"

namespace ibrdf {
namespace {

// Maps are looked at in this size: wide enough for a hard shadow.
constexpr int kProbeWidth = 128;
constexpr BrdfGridShape kProbeGrid = {48, 20, 12};

CookTorrance ProbeMaterial(double specular) {
  CookTorrance brdf;
  brdf.diffuse = Eigen::Array3d::Constant(specular > 0.0 ? 0.1 : 0.5);
  brdf.specular = Eigen::Array3d::Constant(specular);
  brdf.roughness = Eigen::Array3d::Constant(0.15);
  return brdf;
}

OmissionErrors Predict(const Scene& scene,
                       const std::vector<ShadingPoint>& points,
                       const Image* known_map, const BrdfGrid* known_brdf,
                       const SceneProbeOptions& options) {
  const Image sky = RenderSky(SkyOptions(), kProbeWidth / 2, kProbeWidth);
  const Image* map = known_map != nullptr ? known_map : &sky;
  Image small;
  if (map->width > kProbeWidth || map->height > kProbeWidth) {
    small = ResizeMap(*map, kProbeWidth / 2, kProbeWidth);
    map = &small;
  }
  if (known_brdf != nullptr) {
    return PredictEffects(scene, points, {{map, known_brdf}}, options);
  }
  const BrdfGrid matte =
      BrdfGrid::FromFunction(ProbeMaterial(0.0).Function(), kProbeGrid);
  const BrdfGrid glossy =
      BrdfGrid::FromFunction(ProbeMaterial(1.0).Function(), kProbeGrid);
  return PredictEffects(scene, points, {{map, &matte}, {map, &glossy}},
                        options);
}

std::string Bounces(int count) {
  return std::to_string(count) + (count == 1 ? " bounce" : " bounces");
}

std::string InWords(const EffectsPlan& plan, EffectsMode mode) {
  const std::string seen = Format(
      "the object hides %.1f %% of the light from itself, from %.0f %% of its "
      "points some",
      100 * plan.probe.hidden_mean, 100 * plan.probe.shadowed_share);
  const std::string omission = Format(
      "log radiance, mean over the image, would change by %.4f without "
      "shadows and by %.4f without light from the object to itself (worth it "
      "above %.3f)",
      plan.omission.unshadowed, plan.omission.bounces[0], plan.threshold);
  const std::string seconds =
      Format("; rays take about %.1f s for shadows, %.1f s for bounces",
             plan.omission.shadow_seconds, plan.omission.bounce_seconds);
  const std::string asked = mode == EffectsMode::kAuto ? "" : ", as asked";
  const std::string left =
      mode != EffectsMode::kAuto && plan.error > plan.threshold
          ? Format("; reflectance and light absorb the %.4f that is left out",
                   plan.error)
          : "";
  std::string simulated = "none";
  if (plan.visibility) simulated = "visibility";
  if (plan.bounces > 0) {
    simulated += ", interreflection (" + Bounces(plan.bounces) + ")";
  }
  return simulated + asked + ": " + seen + "; " + omission +
         (plan.probe.shadowed_share > 0.0 ? seconds : "") + left;
}

// The cheapest that leaves no more out than the threshold, of what may be
// chosen.
void Choose(bool may_leave_shadows, bool may_bounce, EffectsPlan* plan) {
  plan->visibility = true;
  plan->bounces = may_bounce ? kMostBounces : 0;
  for (int b = plan->bounces; b >= 0; --b) {
    if (plan->omission.bounces[b] <= plan->threshold) plan->bounces = b;
  }
  if (may_leave_shadows && plan->omission.unshadowed <= plan->threshold) {
    plan->visibility = false;
    plan->bounces = 0;
  }
}

// Radiance depends on the normal alone.
bool DependsOnNormal(const Problem& problem, bool visibility) {
  const EffectsSpec& effects = problem.effects;
  const bool allowed = effects.mode == EffectsMode::kAuto ||
                       effects.mode == EffectsMode::kAll ||
                       effects.Lists(Effect::kReflectanceMap);
  return allowed && !visibility &&
         problem.camera.type == CameraType::kOrthographic;
}

}  // namespace

StatusOr<EffectsPlan> PlanEffects(const Problem& problem, const Scene& scene,
                                  const std::vector<ShadingPoint>& points,
                                  const Image* known_map,
                                  const BrdfGrid* known_brdf, double threshold,
                                  int num_threads,
                                  const EffectsMeasure& measure) {
  EffectsPlan plan;
  plan.threshold = threshold;
  plan.reflectance_map = DependsOnNormal(problem, false);
  const EffectsSpec& effects = problem.effects;
  const bool interreflection = effects.Lists(Effect::kInterreflection);
  // Where light is bounced it is also blocked.
  const bool visibility = interreflection || effects.Lists(Effect::kVisibility);
  if (problem.geometry.kind == GeometryKind::kNormals) {
    if (visibility) {
      return InvalidInput(
          problem.path + ": effects",
          std::string(interreflection ? "interreflection" : "visibility") +
              " needs a shape: expected geometry sphere or mesh, found "
              "normals");
    }
    plan.words =
        "none: a normal map has no positions, so that shadows and "
        "interreflection are not simulated; where the object is not convex, "
        "reflectance and light absorb them";
    return plan;
  }
  if (!scene.CastsShadows()) {
    plan.words =
        "none: the sphere is convex, no point shadows or lights another";
    return plan;
  }
  SceneProbeOptions options;
  options.num_threads = num_threads;
  plan.probe = ProbeScene(scene, points, options);
  if (plan.probe.shadowed_share > 0.0) {
    plan.omission =
        measure ? measure()
                : Predict(scene, points, known_map, known_brdf, options);
  }
  switch (effects.mode) {
    case EffectsMode::kAuto:
      Choose(true, true, &plan);
      break;
    case EffectsMode::kAll:
      plan.visibility = true;
      plan.bounces = kMostBounces;
      break;
    case EffectsMode::kNone:
      break;
    case EffectsMode::kList:
      if (visibility) Choose(false, interreflection, &plan);
      if (interreflection) plan.bounces = std::max(plan.bounces, 1);
      break;
  }
  plan.reflectance_map = DependsOnNormal(problem, plan.visibility);
  plan.error = plan.visibility ? plan.omission.bounces[plan.bounces]
                               : plan.omission.unshadowed;
  plan.words = InWords(plan, effects.mode);
  return plan;
}

}  // namespace ibrdf
