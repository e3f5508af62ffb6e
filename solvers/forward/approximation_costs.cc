#include "ibrdf/solvers/forward/approximation_costs.h"

#include "ibrdf/approximation/harmonics.h"

namespace ibrdf {
namespace {

// Measured (experiments/benchmarks/render_speed, `gaussians`). A point takes,
// by quadrature in a preview, in harmonics of order l, and in a Gaussian:
constexpr double kQuadraturePoint = 1.3e-4;
constexpr double kHarmonicPoint = 4e-7, kHarmonicCube = 5e-9;
constexpr double kGaussianPoint = 5e-8;
// A scene takes beside: Y at the quadrature's directions, per harmonic; tables
// of Gaussians, each; points that are compared, at reference quality.
constexpr double kHarmonicScene = 2e-3, kHarmonicSceneEach = 2e-4;
constexpr double kGaussianScene = 1e-2, kGaussianSceneEach = 3e-4;
// By normal: points that are compared, and nodes over the number of harmonics
// that the radiance needs, or nodes where those are too many to tell.
constexpr double kMapChecks = 256, kMapNodes = 6, kRoughMapNodes = 4000;

double Cube(double x) { return x * x * x; }

}  // namespace

double QuadratureSeconds(double points) { return points * kQuadraturePoint; }

double HarmonicSeconds(int order, double points) {
  return kHarmonicScene + kHarmonicSceneEach * NumHarmonics(order) +
         points * (kHarmonicPoint + kHarmonicCube * Cube(order + 1));
}

double GaussianSeconds(int spread, double points) {
  return kGaussianScene + (kGaussianSceneEach + kGaussianPoint * points) *
                              static_cast<double>(spread);
}

double ReflectanceMapSeconds(int order) {
  const double nodes = order >= 0 ? kMapChecks + kMapNodes * NumHarmonics(order)
                                  : kRoughMapNodes;
  return kQuadraturePoint * nodes;
}

}  // namespace ibrdf
