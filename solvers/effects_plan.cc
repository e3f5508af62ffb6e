#include "solvers/effects_plan.h"

#include <algorithm>
#include <cstdio>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/light/procedural_sky.h"

namespace ibrdf {
namespace {

// Maps are looked at in this size: wide enough for a hard shadow.
constexpr int kProbeWidth = 128;
constexpr BrdfGridShape kProbeGrid = {48, 20, 12};

std::string Format(const char* format, double a, double b = 0, double c = 0) {
  char text[256];
  std::snprintf(text, sizeof(text), format, a, b, c);
  return text;
}

bool Listed(const EffectsSpec& effects, Effect effect) {
  return std::find(effects.list.begin(), effects.list.end(), effect) !=
         effects.list.end();
}

CookTorrance ProbeMaterial(double specular) {
  CookTorrance brdf;
  brdf.diffuse = Eigen::Array3d::Constant(specular > 0.0 ? 0.1 : 0.5);
  brdf.specular = Eigen::Array3d::Constant(specular);
  brdf.roughness = Eigen::Array3d::Constant(0.15);
  return brdf;
}

ShadowWorth Predict(const Scene& scene, const std::vector<ShadingPoint>& points,
                    const Image* known_map, const BrdfGrid* known_brdf,
                    const SceneProbeOptions& options) {
  const Image sky = RenderSky(SkyOptions(), kProbeWidth / 2, kProbeWidth);
  const Image* map = known_map != nullptr ? known_map : &sky;
  Image small;
  if (map->width > kProbeWidth) {
    small = ResizeMap(*map, kProbeWidth / 2, kProbeWidth);
    map = &small;
  }
  if (known_brdf != nullptr) {
    return PredictShadowWorth(scene, points, {{map, known_brdf}}, options);
  }
  const BrdfGrid matte =
      BrdfGrid::FromFunction(ProbeMaterial(0.0).Function(), kProbeGrid);
  const BrdfGrid glossy =
      BrdfGrid::FromFunction(ProbeMaterial(1.0).Function(), kProbeGrid);
  return PredictShadowWorth(scene, points, {{map, &matte}, {map, &glossy}},
                            options);
}

std::string InWords(const EffectsPlan& plan, EffectsMode mode) {
  const std::string seen = Format(
      "the object hides %.1f %% of the light from itself, from %.0f %% of its "
      "points some",
      100 * plan.probe.hidden_mean, 100 * plan.probe.shadowed_share);
  const std::string worth = Format(
      "leaving shadows out would change log radiance by %.4f, mean over the "
      "image (worth it above %.3f); their rays take about %.1f s",
      plan.worth.log_error, plan.threshold, plan.worth.seconds);
  const std::string asked = mode == EffectsMode::kAuto ? "" : ", as asked";
  if (plan.visibility) {
    return "visibility" + asked + ": " + seen + "; " + worth +
           "; interreflection is not simulated";
  }
  if (mode != EffectsMode::kAuto) {
    return "none" + asked + ": " + seen + "; " + worth +
           "; reflectance and light absorb what is left out";
  }
  return "none: " + seen + "; " + worth;
}

}  // namespace

StatusOr<EffectsPlan> PlanEffects(const Problem& problem, const Scene& scene,
                                  const std::vector<ShadingPoint>& points,
                                  const Image* known_map,
                                  const BrdfGrid* known_brdf, double threshold,
                                  int num_threads) {
  EffectsPlan plan;
  plan.threshold = threshold;
  const EffectsSpec& effects = problem.effects;
  if (problem.geometry.kind == GeometryKind::kNormals) {
    if (Listed(effects, Effect::kVisibility)) {
      return InvalidInput(problem.path + ": effects",
                          "visibility needs a shape: expected geometry sphere "
                          "or mesh, found normals");
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
    plan.worth = Predict(scene, points, known_map, known_brdf, options);
  }
  switch (effects.mode) {
    case EffectsMode::kAuto:
      plan.visibility = plan.worth.log_error > threshold;
      break;
    case EffectsMode::kAll:
      plan.visibility = true;
      break;
    case EffectsMode::kNone:
      break;
    case EffectsMode::kList:
      plan.visibility = Listed(effects, Effect::kVisibility);
      break;
  }
  plan.words = InWords(plan, effects.mode);
  return plan;
}

}  // namespace ibrdf
