// What simple methods reach on the same image: the numbers to beat.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/image/image.h"
#include "ibrdf/metrics/illumination_metrics.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

struct CookTorranceFitOptions {
  // Where there are more points, about so many are kept, those of every n-th
  // row and column:
  // the limb keeps the share that it has in the image.
  int max_points = 512;
  // Starts: each of these with each of those, its colours fitted first, which
  // needs one render. The best few then take a few steps in all parameters, and
  // the best of them goes on.
  std::vector<double> start_roughness = {0.02, 0.05, 0.1, 0.2, 0.35, 0.6};
  std::vector<double> start_f0 = {0.05, 0.5};
  int refined_starts = 2;
  int refining_steps = 6;
  double smoothing = 0.005;  // of the Laplacian's |d|, natural log
  int max_iterations = 25;   // after those
  double tolerance = 1e-4;   // relative decrease of the cost to stop at
  int num_threads = 0;       // <= 0: all
};

struct CookTorranceFit {
  CookTorrance brdf;    // roughness and f0 are the same in all channels
  double misfit = 0.0;  // mean |log L_o - log I| over the kept points, channels
};

// Lambertian plus Cook-Torrance fitted to an image under known light, by
// Levenberg-Marquardt from several roughnesses and reflectances; the start that
// ends lowest is kept. points: one per pixel at least, as FindShadingPoints
// gives them for this image; those of pixels that are not finite are left out.
// map: radiance, width even. The floor inside the logarithms is 1e-6 of the
// largest pixel. Fails when no pixel is > 0 or no start has a finite cost; the
// message starts with "image".
StatusOr<CookTorranceFit> FitCookTorrance(
    const std::vector<ShadingPoint>& points, const Image& image,
    const Image& map, const CookTorranceFitOptions& options);

// Error of the constant map that has the reference's mean radiance in each
// channel: what an estimate scores that knows the mean and nothing else.
StatusOr<IlluminationMetrics> ScoreConstantMap(const Image& reference);

}  // namespace ibrdf
