// One lobe fitted to an image under known light: by the library, and by least
// squares on logarithms in float.
#pragma once
#include <vector>

#include "experiments/validation/stability/plain_scene.h"
#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/image/image.h"
#include "ibrdf/solvers/priors/prior_costs.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace stability {

using NaiveScene = PlainScene<NaiveArithmetic>;
using PreciseScene = PlainScene<PreciseArithmetic>;

// A sphere seen from the front under maps of 32x16, in the three arithmetics.
struct SphereScene {
  static constexpr int kMapHeight = 16, kMapWidth = 32;

  explicit SphereScene(int image_size);

  // The radiance of the points, from an image of image_size.
  std::vector<double> RadianceOf(const Image& image) const;
  // The other way; pixels beside the points are 0.
  Image ImageOf(const std::vector<double>& radiance) const;

  int image_size;
  std::vector<ShadingPoint> points;
  TransportOptions options;
  Transport transport;
  PreciseScene precise;
  NaiveScene naive;
};

// Parameters of one lobe as LobeModel's: a material half way between two of the
// embedding; and where both fits start, the first of the two with the mean
// colour of all.
std::vector<double> TrueLobe(const NeuralBrdfModel& model);
std::vector<double> StartLobe(const NeuralBrdfModel& model);
double MeanLogColour(const NeuralBrdfModel& model);

// q^exponent at the nodes of the scene's grid, [nodes].
std::vector<Real> PreciseField(const NeuralBrdfModel& model,
                               const BrdfGridShape& grid,
                               const std::vector<double>& lobe);
std::vector<float> NaiveField(const NeuralBrdfModel& model,
                              const BrdfGridShape& grid,
                              const std::vector<double>& lobe);

// Radiance [points * 3] in long double.
std::vector<Real> PreciseRadiance(const SphereScene& scene,
                                  const std::vector<Real>& field,
                                  const std::vector<double>& lobe,
                                  const Image& map);

// exp(a_c) kMerlScale[c].
template <typename T>
T PlainColour(const std::vector<double>& lobe, int channel) {
  return std::exp(static_cast<T>(lobe[lobe.size() - 3 + channel])) *
         static_cast<T>(kMerlScale[channel]);
}

// As an estimate under known light goes: units, masks, epsilon and scales of
// solvers/estimate, and SolveReflectance.
std::vector<double> FitLibrary(const NeuralBrdfModel& model,
                               const SphereScene& scene, const Image& image,
                               const Image& map, const LobePrior& prior);

// Levenberg and Marquardt on log L_o - log I. `leave_out`: pixels of which a
// value is <= 0. Not a number where the cost of the start is not.
std::vector<double> FitNaive(const NeuralBrdfModel& model,
                             const SphereScene& scene, const Image& image,
                             const Image& map, bool leave_out);

// RMS difference of log f over channels and the grid's nodes with both
// directions within 80 degrees of the normal.
double BrdfError(const NeuralBrdfModel& model, const BrdfGridShape& grid,
                 const std::vector<double>& truth,
                 const std::vector<double>& estimate);

}  // namespace stability
}  // namespace ibrdf
