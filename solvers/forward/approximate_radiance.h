// Approximations of radiance that nothing shadows, and which of them renders
// an image.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/approximation/gaussian_transport.h"
#include "ibrdf/approximation/harmonic_transport.h"
#include "ibrdf/approximation/reflectance_map.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/effects/effects_plan.h"
#include "ibrdf/solvers/forward/scene_radiance.h"

namespace ibrdf {

struct ApproximationOptions {
  // What may be taken beside the quadrature.
  bool reflectance_map = false, harmonics = false, gaussians = false;
  // The user asks for harmonics or Gaussians: of those, the fastest within the
  // error or else the one that is predicted to be nearest to it.
  bool forced = false;
  double log_error = 3e-3;  // mean over points and channels
};

// The tier of one scene. Keeps references to the map and the BRDF.
class ApproximateRadiance {
 public:
  ApproximateRadiance(const Image& map, const KnownBrdf& brdf, int num_threads);
  ~ApproximateRadiance();

  // Takes the tier with the least predicted seconds of those whose error is
  // predicted and, by `reference` at points of the image, found to be within
  // the requested one, or else within that of the quadrature. Goes by counts,
  // not by a clock: the same scene is rendered alike anywhere. False: a
  // renderer stopped.
  bool Choose(const std::vector<ShadingPoint>& points,
              const PointRenderer& quadrature, const PointRenderer& reference,
              const ApproximationOptions& options);

  const ApproximationPlan& plan() const { return plan_; }
  // Whether Render does: by harmonics or Gaussians.
  bool renders() const {
    return plan_.approximation == Approximation::kHarmonics ||
           plan_.approximation == Approximation::kGaussians;
  }
  // [points, 3], >= 0.
  void Render(const std::vector<ShadingPoint>& points, double* L_o);

 private:
  struct Candidate {
    Approximation approximation = Approximation::kQuadrature;
    int size = 0;  // order of harmonics, spread Gaussians
    double seconds = 0.0, predicted = 0.0;
    int spots = 0;  // of Gaussians
  };
  struct Gaussians;

  void RenderBy(const Candidate& candidate,
                const std::vector<ShadingPoint>& points, double* L_o);
  // At points of the image: mean |log error| of harmonics up to each order;
  // of Gaussians, where the radiance is L_o.
  std::vector<double> PredictByOrder(
      const std::vector<ShadingPoint>& few) const;
  void PredictGaussians(const std::vector<ShadingPoint>& few,
                        const std::vector<double>& L_o,
                        Candidate* candidate) const;
  HarmonicOptions ProbeOptions() const;
  void Take(const Candidate& candidate, double found,
            const ApproximationOptions& options);

  const Image& map_;
  const KnownBrdf& brdf_;
  const int num_threads_;
  BrdfGrid grid_;                               // for harmonics
  std::unique_ptr<const Gaussians> gaussians_;  // of spread_
  int spread_ = 0;
  Candidate taken_;
  ApproximationPlan plan_;
};

}  // namespace ibrdf
