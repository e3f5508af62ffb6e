// Forward rendering of a problem whose reflectance and illumination are known.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/effects/effects_plan.h"

namespace ibrdf {

// What a renderable problem's camera sees: 2x2 points a pixel at reference
// quality, else one.
struct ViewPoints {
  // By view angle: those of one angle share their work when they are rendered
  // together.
  std::vector<ShadingPoint> points;
  Mask mask;  // pixels with a point
  Scene scene = Scene::UnitSphere();
};
StatusOr<ViewPoints> FindViewPoints(const Problem& problem,
                                    int num_threads = 0);

// Multiplies each channel of each pixel by exp(sigma * normal), row-major; the
// same seed gives the same noise anywhere.
void AddNoise(double sigma, uint64_t seed, Image* image);

struct RenderSceneOptions {
  uint64_t seed = 1;    // of the noise, where the problem has no seed
  int num_threads = 0;  // <= 0: all
  // Called with the share done, in [0, 1], from the calling thread; false
  // stops the render. May be empty.
  std::function<bool(double)> progress;
  // Only `effects` of the result is filled in: what would be simulated.
  bool plan_only = false;
};

struct RenderedScene {
  Image image;         // radiance; 0 outside the object
  Mask mask;           // pixels whose centre (preview) or any sample sees it
  Image illumination;  // the map used
  EffectsPlan effects;
};

// Reference quality: 2x2 samples a pixel; preview: one, but for pixels that it
// does not stand for (PixelsToSample), and a coarser quadrature. Analytic BRDFs
// are evaluated, not tabulated. Noise multiplies each channel of each pixel by
// exp(noise * normal). CheckRenderable first.
StatusOr<RenderedScene> RenderScene(const Problem& problem,
                                    const RenderSceneOptions& options);

}  // namespace ibrdf
