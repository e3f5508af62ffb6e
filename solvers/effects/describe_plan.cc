#include "ibrdf/solvers/effects/describe_plan.h"

#include "ibrdf/base/format.h"

namespace ibrdf {
namespace {

std::string Simulated(const EffectsPlan& plan) {
  std::string text = plan.visibility ? "visibility" : "none";
  if (plan.bounces > 0) {
    text += ", interreflection (" + std::to_string(plan.bounces) +
            (plan.bounces == 1 ? " bounce)" : " bounces)");
  }
  return text + (plan.mode == EffectsMode::kAuto ? "" : ", as asked");
}

std::string Hidden(const SceneProbe& probe) {
  return Format(
      "the object hides %.1f %% of the light from itself, from %.0f %% of its "
      "points some",
      100 * probe.hidden_mean, 100 * probe.shadowed_share);
}

std::string Omissions(const EffectsPlan& plan) {
  return Format(
      "log radiance, mean over the image, would change by %.4f without shadows "
      "and bounces, and by %.4f with shadows alone (shadows are simulated if "
      "the first is above %.3f, bounces if both are)",
      plan.omission.unshadowed, plan.omission.bounces[0], plan.threshold);
}

std::string Seconds(const EffectsPlan& plan) {
  if (plan.probe.shadowed_share <= 0.0) return "";
  return Format("; rays take about %.1f s for shadows, %.1f s for bounces",
                plan.omission.shadow_seconds, plan.omission.bounce_seconds);
}

// What a user's choice leaves out.
std::string LeftOut(const EffectsPlan& plan) {
  if (plan.mode == EffectsMode::kAuto || plan.error <= plan.threshold) {
    return "";
  }
  return Format("; reflectance and light absorb the %.4f that is left out",
                plan.error);
}

}  // namespace

std::string Describe(const EffectsPlan& plan) {
  switch (plan.shape) {
    case ShapeKind::kNormalMap:
      return "none: a normal map has no positions, so that shadows and "
             "interreflection are not simulated; where the object is not "
             "convex, reflectance and light absorb them";
    case ShapeKind::kConvex:
      return "none: the sphere is convex, no point shadows or lights another";
    case ShapeKind::kMesh:
      break;
  }
  return Simulated(plan) + ": " + Hidden(plan.probe) + "; " + Omissions(plan) +
         Seconds(plan) + LeftOut(plan);
}

}  // namespace ibrdf
