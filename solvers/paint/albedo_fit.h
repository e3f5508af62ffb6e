// Log albedo at every pixel, given the reflectance and the light.
#pragma once
#include <vector>

#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/priors/albedo_prior.h"

namespace ibrdf {

// What the unpainted object would show [points * 3]: the radiance of the part
// that paint scales, and the rest.
struct UnpaintedRadiance {
  std::vector<double> matte, gloss;
};

struct AlbedoFitOptions {
  AlbedoPrior prior;
  // Deviation of log radiance between image and render that is not paint's: of
  // the reflectance, the light and the normals.
  double shading_std = 0.1;
  int iterations = 5;
};

// Log albedo a [points * 3], I = e^a matte + gloss. Luminance is drawn to that
// of points of like colour, as far as a deviation of shading_std explains what
// is left; what is more is the point's own, as a sharp print is (a Student-t
// prior of three degrees, by reweighting). Chroma is the image's. Where the
// gloss alone is as bright as the image, or nothing was observed, the albedo is
// that of its colour's.
std::vector<double> FitAlbedo(const UnpaintedRadiance& unpainted,
                              const Observations& observed,
                              const AlbedoFitOptions& options);

// (e^a matte + gloss) / (matte + gloss) [points * 3].
std::vector<double> PaintGain(const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo);

}  // namespace ibrdf
