// Which effects a problem is solved or rendered with.
//
// Light that reaches the object straight is always simulated. Two effects come
// on top where the object is not convex: shadows (`visibility`), and light
// from the object to itself (`interreflection`, some bounces of it). They cost
// rays, and many objects hardly show them. `effects: auto` decides in three
// steps:
//
//   1. Probe. A few rays from a few points tell how much of the light the
//      object hides from itself (ProbeScene). Where nothing is hidden, nothing
//      is simulated.
//   2. Predict omission errors. The omission error of an effect is the mean
//      change of log radiance over the image when the effect is left out. The
//      probed points are rendered with and without it, under the known light
//      and reflectance, or under stand-ins where one of them is unknown.
//   3. Choose. Of {nothing, shadows, shadows and b bounces} the cheapest is
//      taken whose omission error is within the threshold.
//
// A user who lists effects overrules step 3 and is told what is left out.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/render/scene_probe.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// Thresholds on the omission error (natural log) in a solve, in a preview, and
// in a render at reference quality, which others measure themselves against.
inline constexpr double kSolveOmissionError = 0.01;
inline constexpr double kPreviewOmissionError = 0.005;
inline constexpr double kReferenceOmissionError = 0.001;

// What the shape leaves to decide.
enum class ShapeKind {
  kConvex,     // a sphere: no point shadows or lights another
  kNormalMap,  // no positions: neither shadows nor bounces can be simulated
  kMesh,       // probed
};

struct EffectsPlan {
  // The decision.
  bool visibility = false;  // shadows
  int bounces = 0;          // [0, kMostBounces]; > 0 only with visibility
  // Whether radiance depends on the normal alone, and the user does not mind
  // its being interpolated between normals: no shadows, and an orthographic
  // camera.
  bool reflectance_map = false;

  // What it was taken from.
  EffectsMode mode = EffectsMode::kAuto;  // what the user asks for
  ShapeKind shape = ShapeKind::kConvex;
  SceneProbe probe;         // of a mesh
  OmissionErrors omission;  // where the probe found shadows
  double threshold = kSolveOmissionError;
  double error = 0.0;  // omission error of the decision
};

// Measures the omission errors of a scene, in place of their prediction.
using EffectsMeasure = std::function<OmissionErrors()>;

struct EffectsOptions {
  double threshold = kSolveOmissionError;  // > 0
  // What is known of the scene; null: unknown. Not owned.
  const Image* known_map = nullptr;
  const BrdfGrid* known_brdf = nullptr;
  // Empty: PredictEffects, which sees the object as patches. Mirrors need
  // another way (MeasureEffects).
  EffectsMeasure measure;
  int num_threads = 0;  // <= 0: all
};

// `points`: of the image. Fails where the problem lists an effect that its
// geometry cannot have.
StatusOr<EffectsPlan> PlanEffects(const Problem& problem, const Scene& scene,
                                  const std::vector<ShadingPoint>& points,
                                  const EffectsOptions& options);

}  // namespace ibrdf
