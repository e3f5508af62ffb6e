// Which effects a problem is solved or rendered with, and why.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/render/scene_probe.h"
#include "ibrdf/visibility/visibility.h"

namespace ibrdf {

// `auto` simulates an effect where leaving it out is predicted to change log
// radiance by more than this, mean over the image: in a solve, in a preview,
// and in a render at reference quality, which others measure themselves
// against.
inline constexpr double kSolveOmissionError = 0.01;
inline constexpr double kPreviewOmissionError = 0.005;
inline constexpr double kReferenceOmissionError = 0.001;

// How points are rendered that nothing shadows.
enum class Approximation {
  kQuadrature,      // each by itself
  kReflectanceMap,  // as many as it takes, the rest interpolated by normal
  kHarmonics,       // the map in spherical harmonics
  kGaussians,       // the map as a mixture of spherical Gaussians
};

struct ApproximationPlan {
  Approximation approximation = Approximation::kQuadrature;
  int order = 0;                 // of the harmonics
  int gaussians = 0, spots = 0;  // in the mixture; bright spots among them
  // Of harmonics and Gaussians, mean |log error|: predicted from the light that
  // is left out, and found, with two standard errors, at `checked` points of
  // the image that are rendered at reference quality; of the quadrature, found
  // likewise.
  double predicted_error = 0.0, found_error = 0.0, quadrature_error = 0.0;
  int checked = 0;
  // Predicted from counts, not from a clock: of this tier and of the
  // quadrature, on one core.
  double seconds = 0.0, quadrature_seconds = 0.0;
  std::string words;  // for the user
};

struct EffectsPlan {
  bool visibility = false;
  int bounces = 0;  // of light from the object to itself; with visibility alone
  // Whether an image is rendered once for all points of like normals: without
  // shadows, seen by an orthographic camera.
  bool reflectance_map = false;
  SceneProbe probe;
  // Predicted under the known light and reflectance; where one is unknown,
  // under a sun in a clear sky, and for a matte and a glossy surface.
  OmissionErrors omission;
  double threshold = kSolveOmissionError;
  // The predicted error of what is simulated.
  double error = 0.0;
  std::string words;  // for the user
  // Of ibrdf_render, where neither shadows nor bounces are simulated.
  ApproximationPlan approximation;
};

// Worth of the effects, where they are not to be predicted by patches of the
// object, as a solve simulates them.
using EffectsMeasure = std::function<OmissionErrors()>;

// known_map, known_brdf and `measure` may be null. Fails where the problem
// lists an effect that its geometry cannot have.
StatusOr<EffectsPlan> PlanEffects(const Problem& problem, const Scene& scene,
                                  const std::vector<ShadingPoint>& points,
                                  const Image* known_map,
                                  const BrdfGrid* known_brdf, double threshold,
                                  int num_threads,
                                  const EffectsMeasure& measure = nullptr);

}  // namespace ibrdf
