#include "ibrdf/solvers/effects/effects_plan.h"

#include <glog/logging.h>

#include <algorithm>
#include <string>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/light/procedural_sky.h"

namespace ibrdf {
namespace {

// Maps are looked at in this size: wide enough for a hard shadow.
constexpr int kProbeWidth = 128;
constexpr BrdfGridShape kProbeGrid = {48, 20, 12};

// Stands in for an unknown reflectance: matte, or glossy over a dark base.
BrdfGrid StandInMaterial(double specular) {
  CookTorrance brdf;
  brdf.diffuse = Eigen::Array3d::Constant(specular > 0.0 ? 0.1 : 0.5);
  brdf.specular = Eigen::Array3d::Constant(specular);
  brdf.roughness = Eigen::Array3d::Constant(0.15);
  return BrdfGrid::FromFunction(brdf.Function(), kProbeGrid);
}

// Where light is bounced it is also blocked.
bool AsksForShadows(const EffectsSpec& effects) {
  return effects.Lists(Effect::kInterreflection) ||
         effects.Lists(Effect::kVisibility);
}

ShapeKind ShapeOf(const Problem& problem, const Scene& scene) {
  if (problem.geometry.HasNormalMap()) {
    return ShapeKind::kNormalMap;
  }
  return scene.CastsShadows() ? ShapeKind::kMesh : ShapeKind::kConvex;
}

Status CheckShapeHasPositions(const Problem& problem, ShapeKind shape) {
  if (shape != ShapeKind::kNormalMap || !AsksForShadows(problem.effects)) {
    return OkStatus();
  }
  const bool bounces = problem.effects.Lists(Effect::kInterreflection);
  return InvalidInput(
      problem.path + ": effects",
      std::string(bounces ? "interreflection" : "visibility") +
          " needs a shape: expected geometry sphere or mesh, "
          "found " +
          (problem.geometry.kind == GeometryKind::kDepth ? "depth"
                                                         : "normals"));
}

// Under the known light and reflectance. A sun in a clear sky stands in for an
// unknown light, the worse of a matte and a glossy surface for an unknown
// reflectance.
OmissionErrors PredictOmissions(const Scene& scene,
                                const std::vector<ShadingPoint>& points,
                                const EffectsOptions& options,
                                const SceneProbeOptions& probe) {
  const Image sky = RenderSky(SkyOptions(), kProbeWidth / 2, kProbeWidth);
  const Image* map = options.known_map != nullptr ? options.known_map : &sky;
  Image small;
  if (map->width > kProbeWidth || map->height > kProbeWidth) {
    small = ResizeMap(*map, kProbeWidth / 2, kProbeWidth);
    map = &small;
  }
  if (options.known_brdf != nullptr) {
    return PredictEffects(scene, points, {{map, options.known_brdf}}, probe);
  }
  const BrdfGrid matte = StandInMaterial(0.0), glossy = StandInMaterial(1.0);
  return PredictEffects(scene, points, {{map, &matte}, {map, &glossy}}, probe);
}

// The fewest bounces, at most `most`, that leave no more out than the
// threshold; `most` where none do.
int FewestBounces(const OmissionErrors& omission, double threshold, int most) {
  int fewest = most;
  for (int b = most; b >= 0; --b) {
    if (omission.bounces[b] <= threshold) fewest = b;
  }
  return fewest;
}

// Sets the decision from the omission errors and what the user asks for.
void Choose(const EffectsSpec& effects, EffectsPlan* plan) {
  const bool lists_bounces = effects.Lists(Effect::kInterreflection);
  switch (effects.mode) {
    case EffectsMode::kAuto:
      if (plan->omission.unshadowed <= plan->threshold) break;
      plan->visibility = true;
      plan->bounces =
          FewestBounces(plan->omission, plan->threshold, kMostBounces);
      break;
    case EffectsMode::kAll:
      plan->visibility = true;
      plan->bounces = kMostBounces;
      break;
    case EffectsMode::kNone:
      break;
    case EffectsMode::kList:
      plan->visibility = AsksForShadows(effects);
      if (lists_bounces) {
        plan->bounces = std::max(
            1, FewestBounces(plan->omission, plan->threshold, kMostBounces));
      }
      break;
  }
}

bool DependsOnNormal(const Problem& problem, bool visibility) {
  const EffectsSpec& effects = problem.effects;
  const bool allowed = effects.mode == EffectsMode::kAuto ||
                       effects.mode == EffectsMode::kAll ||
                       effects.Lists(Effect::kReflectanceMap);
  return allowed && !visibility && !problem.SeveralViews() &&
         problem.camera.type == CameraType::kOrthographic;
}

}  // namespace

StatusOr<EffectsPlan> PlanEffects(const Problem& problem, const Scene& scene,
                                  const std::vector<ShadingPoint>& points,
                                  const EffectsOptions& options) {
  CHECK_GT(options.threshold, 0.0);
  EffectsPlan plan;
  plan.mode = problem.effects.mode;
  plan.shape = ShapeOf(problem, scene);
  plan.threshold = options.threshold;
  IBRDF_RETURN_IF_ERROR(CheckShapeHasPositions(problem, plan.shape));
  if (plan.shape == ShapeKind::kMesh) {
    SceneProbeOptions probe;
    probe.num_threads = options.num_threads;
    plan.probe = ProbeScene(scene, points, probe);
    if (plan.probe.shadowed_share > 0.0) {
      plan.omission = options.measure
                          ? options.measure()
                          : PredictOmissions(scene, points, options, probe);
    }
    Choose(problem.effects, &plan);
    plan.error = plan.visibility ? plan.omission.bounces[plan.bounces]
                                 : plan.omission.unshadowed;
  }
  plan.reflectance_map = DependsOnNormal(problem, plan.visibility);
  return plan;
}

}  // namespace ibrdf
