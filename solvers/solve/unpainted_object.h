// A painted object without its paint: what its lobes show, and its image.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/solve/summary.h"

namespace ibrdf {

// Lobes where the paint's factor a is 1.
struct UnpaintedReflectance {
  BrdfGrid whole, matte;
  Eigen::Array3d albedo;  // hemispherical, of the matte part
};

UnpaintedReflectance UnpaintedOf(const LobeModel& lobes,
                                 const double* parameters);

// What a white matte object shows at each pixel under the known map [points *
// 3].
std::vector<double> MatteShading(const SolveSetup& setup);

// Radiance at all pixels under a map of this size [H, W, 3].
UnpaintedRadiance RenderUnpainted(const SolveSetup& setup,
                                  const UnpaintedReflectance& reflectance,
                                  const std::vector<float>& map, MapSize size);

// The same in two steps: what is to be rendered to `out`, which must outlive
// it, and, after that, the matte part taken off.
std::vector<BesideRender> UnpaintedRenders(
    const UnpaintedReflectance& reflectance, UnpaintedRadiance* out);
void TakeMatteOff(UnpaintedRadiance* out);

// Multiplies the image at the pixels of points by factors [points * 3].
void ScalePixels(const std::vector<double>& factors,
                 const std::vector<ShadingPoint>& points, Image* image);

// The problem whose image is divided at the points by what paint makes of it
// (PaintGain), > 0.
InverseProblem WithoutPaint(const InverseProblem& problem,
                            const std::vector<double>& gain,
                            const std::vector<ShadingPoint>& points);

// The paint's part of a solution: the albedo of what is matte with its standard
// deviation (AlbedoLogStd's), and the gloss.
void SetPaint(const SolveSetup& setup, const UnpaintedReflectance& reflectance,
              const UnpaintedRadiance& unpainted,
              const std::vector<double>& log_albedo,
              const std::vector<double>& log_std, Solution* solution);

}  // namespace ibrdf
