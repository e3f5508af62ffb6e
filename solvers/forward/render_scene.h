// Forward rendering of a problem whose reflectance and illumination are known:
// load, plan, render.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/forward/pixel_renderer.h"
#include "ibrdf/solvers/forward/render_plan.h"

namespace ibrdf {

struct RenderSceneOptions {
  uint64_t seed = 1;    // of the noise, where the problem has no seed
  int num_threads = 0;  // <= 0: all
  RadianceRenderer::Progress progress;  // may be empty
  // Only `plan` of the result is filled in: what would be simulated.
  bool plan_only = false;
};

struct RenderedScene {
  Image image;         // radiance; 0 outside the object
  Mask mask;           // pixels whose centre (preview) or any sample sees it
  Image illumination;  // the map used
  // A painted or textured object has the BRDF of its mean paint or values.
  std::optional<MerlTable> painted_brdf;
  RenderPlan plan;
  PixelCounts counts;
  std::vector<std::string> warnings;  // of the inputs: sentences for the user
};

// One line for the user: what was simulated, how, and why. Holds seconds, which
// vary from run to run.
std::string Describe(const RenderedScene& rendered);

// Reference quality: 2x2 samples a pixel; preview: one, but for pixels that it
// does not stand for (PixelsToSample), and a coarser quadrature. Analytic BRDFs
// are evaluated, not tabulated. Noise multiplies each channel of each pixel by
// exp(noise * normal). CheckRenderable first.
StatusOr<RenderedScene> RenderScene(const Problem& problem,
                                    const RenderSceneOptions& options);

// Called with one view after another.
using TakeRender =
    std::function<Status(const ViewSpec& view, const RenderedScene& rendered)>;

// The same for every view of problem.views, which share what is read. The
// noise's seed is that of a single render for the first view, the next one for
// the second, and so on. Messages name the view.
Status RenderViews(const Problem& problem, const RenderSceneOptions& options,
                   const TakeRender& take);

}  // namespace ibrdf
