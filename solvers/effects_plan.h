// Which effects a problem is solved or rendered with, and why.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/render/scene_probe.h"
#include "ibrdf/render/visibility.h"
#include "io/problem.h"

namespace ibrdf {

// `auto` simulates an effect where leaving it out is predicted to change log
// radiance by more than this, mean over the image: in a solve, in a preview,
// and in a render at reference quality, which others measure themselves
// against.
inline constexpr double kWorthwhileLogError = 0.01;
inline constexpr double kPreviewLogError = 0.005;
inline constexpr double kReferenceLogError = 0.001;

struct EffectsPlan {
  bool visibility = false;
  int bounces = 0;  // of light from the object to itself; with visibility alone
  // Whether an image is rendered once for all points of like normals: without
  // shadows, seen by an orthographic camera.
  bool reflectance_map = false;
  SceneProbe probe;
  // Predicted under the known light and reflectance; where one is unknown,
  // under a sun in a clear sky, and for a matte and a glossy surface.
  EffectsWorth worth;
  double threshold = kWorthwhileLogError;
  // The predicted error of what is simulated.
  double error = 0.0;
  std::string words;  // for the user
};

// Worth of the effects, where they are not to be predicted by patches of the
// object, as a solve simulates them.
using EffectsMeasure = std::function<EffectsWorth()>;

// known_map, known_brdf and `measure` may be null. Fails where the problem
// lists an effect that its geometry cannot have.
StatusOr<EffectsPlan> PlanEffects(const Problem& problem, const Scene& scene,
                                  const std::vector<ShadingPoint>& points,
                                  const Image* known_map,
                                  const BrdfGrid* known_brdf, double threshold,
                                  int num_threads,
                                  const EffectsMeasure& measure = nullptr);

}  // namespace ibrdf
