// What simple methods reach on the same image: the numbers to beat.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/image/image.h"
#include "ibrdf/metrics/illumination_metrics.h"
#include "ibrdf/render/scene.h"

namespace ibrdf {

struct CookTorranceFitOptions {
  std::vector<double> start_roughness = {0.05, 0.2, 0.5};
  double start_f0 = 0.1;
  double smoothing = 0.005;  // of the Laplacian's |d|, natural log
  int max_iterations = 25;  // of each start
  double tolerance = 1e-5;   // relative decrease of the cost to stop at
  int num_threads = 0;       // <= 0: all
};

struct CookTorranceFit {
  CookTorrance brdf;    // roughness and f0 are the same in all channels
  double misfit = 0.0;  // mean |log E - log I| over the points and channels
};

// Lambertian plus Cook-Torrance fitted to an image under known light, by
// Levenberg-Marquardt from several roughnesses; the start that ends lowest is
// kept. points: one per pixel at least, as FindShadingPoints gives them for
// this image; those of pixels that are not finite are left out. map: radiance,
// width even. The floor inside the logarithms is 1e-6 of the largest pixel.
// Fails when no pixel is > 0 or no start has a finite cost; the message starts
// with "image".
StatusOr<CookTorranceFit> FitCookTorrance(
    const std::vector<ShadingPoint>& points, const Image& image,
    const Image& map, const CookTorranceFitOptions& options);

// Error of the constant map that has the reference's mean radiance in each
// channel: what an estimate scores that knows the mean and nothing else.
StatusOr<IlluminationMetrics> ScoreConstantMap(const Image& reference);

}  // namespace ibrdf
