// What pixels say of an object's paint before its light and its lobes are
// known.
#pragma once
#include <optional>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/neighbours.h"
#include "ibrdf/solvers/paint/shading_light.h"

namespace ibrdf {

struct FirstPaint {
  std::optional<ShadingLight> light;
  UnpaintedRadiance shading;  // of a white matte object under it
  // Log albedo [points * 3], its mean over the points 0 in each channel.
  std::vector<double> log_albedo;
  // Whether no lamp outshines the room: the light's colour then varies with its
  // direction.
  bool natural_light = true;
  // How it was fitted, and is to be fitted under a light that is known better:
  // of natural light, colour that drifts over the object is the light's, unless
  // SmoothShading leaves markedly fewer colours.
  AlbedoFitOptions options;
  // How far log luminance deviates at like normals between the image and this
  // paint under this light: texture, shadows, what neither is.
  double deviation = 0.0;
};

// The albedo (FitAlbedo) of a matte object under the light of
// FindShadingLight, or under even light where there is none. In natural light
// also under SmoothShading, which takes wood's grain for paint where the former
// takes its drift for light; the one with fewer colours is the simpler
// explanation. Highlights say nothing of paint and are filled in from around.
FirstPaint FindFirstPaint(const std::vector<ShadingPoint>& points,
                          const Observations& observed,
                          const std::vector<NeighbourPair>& neighbours);

// What several images of the same points tell of the paint, each under its own
// light.
struct SharedPaint {
  std::vector<double> log_albedo;  // as FirstPaint has it
  AlbedoFitOptions options;        // how it was fitted, and is to be
};

// of_images: FindFirstPaint of each, at least one.
SharedPaint FindSharedPaint(const std::vector<ShadingPoint>& points,
                            const std::vector<const Observations*>& observed,
                            const std::vector<FirstPaint>& of_images,
                            const std::vector<NeighbourPair>& neighbours);

// The log albedo alone, [points * 3] of mean 0, where the shading is known:
// the radiance [points * 3] of a white matte object.
std::vector<double> FirstPaintUnder(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const std::vector<NeighbourPair>& neighbours,
    const AlbedoFitOptions& options, std::vector<double> shading);

}  // namespace ibrdf
