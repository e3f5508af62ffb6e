// Chooses how points that nothing shadows are rendered, and renders them.
//
// Beside the quadrature, point by point, there are the reflectance map, and two
// approximations of the light: spherical harmonics up to an order, and
// mixtures of spherical Gaussians. Which of them is near enough depends on the
// light and the reflectance of the scene. A choice takes three steps:
//
//   1. Predict. A table of candidates is made: seconds from counts, errors from
//      the light that each leaves out.
//   2. Verify. Some points of the image are rendered by the candidate, by the
//      quadrature and at reference quality, and compared.
//   3. Choose. Of the candidates that are faster than the quadrature, and both
//      predicted and found to be within the error, the fastest is taken.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/approximation/harmonic_transport.h"
#include "ibrdf/base/status.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/forward/approximation_plan.h"
#include "ibrdf/solvers/forward/known_brdf.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

struct ApproximationOptions {
  // What may be taken beside the quadrature.
  bool reflectance_map = false, harmonics = false, gaussians = false;
  // The user asks for harmonics or Gaussians: the fastest of those within the
  // error is taken, or else the one that is predicted to be nearest to it.
  bool forced = false;
  double log_error = 3e-3;  // mean over points and channels
  // Mixtures that are tried. Under a small sun 64 Gaussians bring 0.0005 on a
  // matte surface; rough ones under a soft sky need 256 (docs/notes,
  // render_speed).
  std::vector<int> spreads = {64, 128, 256};
  // Points of the image that are compared.
  int checked_points = 64;

  // kInternal names the field that is out of range.
  Status Check() const;
};

// The choice for one scene. Keeps references to the map and the BRDF.
class ApproximateRadiance {
 public:
  ApproximateRadiance(const Image& map, const KnownBrdf& brdf, int num_threads);

  // Where no candidate is within the error, one that is within that of the
  // quadrature is as good. Goes by counts, not by a clock: the same scene is
  // rendered alike anywhere. False: a renderer stopped.
  bool Choose(const std::vector<ShadingPoint>& points,
              const RadianceRenderer& quadrature,
              const RadianceRenderer& reference,
              const ApproximationOptions& options);

  const ApproximationPlan& plan() const { return plan_; }
  // The harmonics or Gaussians that were chosen, null where they were not. It
  // must not outlive *this.
  const RadianceRenderer* renderer() const { return taken_.get(); }

 private:
  // A row of the table.
  struct Candidate {
    Approximation approximation = Approximation::kQuadrature;
    int size = 0;  // order of harmonics, spread Gaussians
    double seconds = 0.0;
    double predicted = 0.0;  // error
    int spots = 0;           // of Gaussians
    int gaussians = 0;       // all of them, once it is verified
    double found = 0.0;      // error, once it is verified
    // Null until it is verified.
    std::shared_ptr<const RadianceRenderer> renderer;
  };
  // Points of the image, and their radiance [points, 3].
  struct Samples {
    std::vector<ShadingPoint> points;
    std::vector<double> quadrature, reference;
  };
  // The plan of points that are rendered each by itself, or by normal.
  void StartPlan(double num_points, const ApproximationOptions& options);
  // Whether harmonics or Gaussians may be taken and save seconds that count.
  bool MayGain(const ApproximationOptions& options) const;
  bool LobeIsTooNarrow(const ApproximationOptions& options);
  // Puts the seconds of the reflectance map, where it may be taken, in place of
  // the quadrature's.
  void PredictReflectanceMap(const std::vector<double>& by_order,
                             const ApproximationOptions& options);
  // Mean |log error| of harmonics up to each order.
  std::vector<double> PredictByOrder(const Samples& at) const;
  // By seconds, the least first.
  std::vector<Candidate> ListCandidates(
      const std::vector<double>& by_order, double num_points,
      const ApproximationOptions& options) const;
  // Fills `predicted` and `spots` in, where they are not.
  void Predict(const Samples& at, Candidate* candidate) const;
  // Whether any candidate is worth rendering the reference for.
  bool AnyPromising(const Samples& at, const ApproximationOptions& options,
                    std::vector<Candidate>* table) const;
  // Sets the candidate's renderer up.
  void SetUp(Candidate* candidate) const;
  // Sets it up and fills `found` in, once.
  void Verify(const Samples& at, Candidate* candidate) const;
  // The first that pays and is predicted and found within `allowed`, or null.
  const Candidate* FirstWithin(double allowed, const Samples& at,
                               const ApproximationOptions& options,
                               std::vector<Candidate>* table);
  // All have been predicted. Null: the quadrature.
  const Candidate* ChooseFrom(const Samples& at,
                              const ApproximationOptions& options,
                              std::vector<Candidate>* table);
  void Take(const Candidate& candidate);
  void Decline(ApproximationVerdict verdict,
               const std::vector<Candidate>& table);

  HarmonicOptions Harmonics(int order, int view_angles) const;

  const Image& map_;
  const KnownBrdf& brdf_;
  const int num_threads_;
  BrdfGrid grid_;  // for harmonics
  std::shared_ptr<const RadianceRenderer> taken_;
  ApproximationPlan plan_;
};

}  // namespace ibrdf
