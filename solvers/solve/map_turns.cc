#include "ibrdf/solvers/solve/map_turns.h"

#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/lambertian.h"

namespace ibrdf {
namespace {

constexpr size_t kMostPixels = 500;
// Of the microfacet lobes: from near a mirror at this map's size to dull, of
// plastic and of metal.
constexpr double kRoughness[] = {0.07, 0.15, 0.35};
constexpr double kF0[] = {0.04, 0.6};
// Weights of the colours' fit, so that outliers count by their absolute value.
constexpr int kReweightings = 5;
constexpr double kSmallResidual = 0.05;
constexpr int kSweeps = 60;
// The best of many turns is somewhat better by chance, and where paint fades
// over the object, far better: 0.2 in place of 0.5 on one ball. But paint
// leaves much under any turn, and a map in the wrong frame leaves little when
// turned, or little of what it leaves as it is where it has small and bright
// lamps.
constexpr double kFarBetter = 0.5, kExplained = 0.1, kBetterByFar = 0.2;
// Renders darker than this share of the image's mean count as that.
constexpr double kDarkestRender = 1e-4;

std::vector<BrdfGrid> SimpleLobes(const BrdfGridShape& shape) {
  std::vector<BrdfGrid> lobes = {BrdfGrid::FromFunction(
      Lambertian{Eigen::Array3d::Ones()}.Function(), shape)};
  for (const double roughness : kRoughness) {
    for (const double f0 : kF0) {
      CookTorrance lobe;
      lobe.diffuse = 0.0;
      lobe.roughness = roughness;
      lobe.f0 = f0;
      lobes.push_back(BrdfGrid::FromFunction(lobe.Function(), shape));
    }
  }
  return lobes;
}

struct SomePixels {
  std::vector<ShadingPoint> points;
  Eigen::MatrixX3d radiance;
};

// Some whose radiance is known, not bounded.
SomePixels SomeOf(const Observation& pixels) {
  const Observations& observed = pixels.observed;
  std::vector<size_t> known;
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    if (HasKnownRadiance(observed, i)) known.push_back(i);
  }
  const size_t stride = (known.size() + kMostPixels - 1) / kMostPixels;
  SomePixels some;
  some.radiance.resize(static_cast<Eigen::Index>(
                           known.empty() ? 0 : (known.size() - 1) / stride + 1),
                       3);
  for (size_t k = 0; k < known.size(); k += stride) {
    for (int c = 0; c < 3; ++c) {
      some.radiance(static_cast<Eigen::Index>(some.points.size()), c) =
          observed.radiance[3 * known[k] + c];
    }
    some.points.push_back(pixels.points[known[k]]);
  }
  return some;
}

// argmin x' A x / 2 - b' x over x >= 0, from x, coordinate by coordinate.
void MinimiseOverPositive(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                          Eigen::VectorXd* x) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Eigen::Index k = 0; k < b.size(); ++k) {
      if (!(A(k, k) > 0.0)) continue;
      const double step = (b[k] - A.row(k).dot(*x)) / A(k, k);
      (*x)[k] = std::max((*x)[k] + step, 0.0);
    }
  }
}

// The sum over pixels of |log radiance| of a channel that the best mixture of
// lobes leaves; shading [pixels, lobes].
double LeftByMixture(const Eigen::MatrixXd& shading,
                     const Eigen::VectorXd& radiance) {
  const Eigen::MatrixXd relative =
      radiance.cwiseInverse().asDiagonal() * shading;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(radiance.size());
  Eigen::VectorXd colours = Eigen::VectorXd::Zero(shading.cols());
  for (int i = 0; i < kReweightings; ++i) {
    const Eigen::MatrixXd weighted = weights.asDiagonal() * relative;
    MinimiseOverPositive(relative.transpose() * weighted,
                         weighted.colwise().sum().transpose(), &colours);
    weights = ((relative * colours).array() - 1.0)
                  .abs()
                  .max(kSmallResidual)
                  .inverse()
                  .matrix();
  }
  const double darkest = kDarkestRender * radiance.mean();
  const Eigen::ArrayXd render = (shading * colours).array().max(darkest);
  return (render.log() - radiance.array().log()).abs().sum();
}

}  // namespace

bool IsFarBetter(const MapTurns& turns) {
  return turns.best.misfit <
             std::min(kFarBetter * turns.as_given, kExplained) ||
         turns.best.misfit < kBetterByFar * turns.as_given;
}

MapTurns FindMapTurns(const SolveSetup& setup) {
  const SomePixels pixels = SomeOf(setup.pixels);
  if (pixels.points.empty()) return {};
  const std::vector<BrdfGrid> lobes = SimpleLobes(setup.transport.grid);
  const TurnedMaps maps(setup, pixels.points, lobes);
  Eigen::MatrixXd under(pixels.radiance.rows(),
                        static_cast<Eigen::Index>(lobes.size()));
  std::vector<double> misfits;
  for (int turn = 0; turn < maps.num_turns(); ++turn) {
    double left = 0.0;
    for (int c = 0; c < 3; ++c) {
      for (size_t k = 0; k < lobes.size(); ++k) {
        under.col(static_cast<Eigen::Index>(k)) = maps.Radiance(turn, k, c);
      }
      left += LeftByMixture(under, pixels.radiance.col(c));
    }
    misfits.push_back(left / static_cast<double>(pixels.radiance.size()));
  }
  const MapTurns found = maps.Best(misfits);
  VLOG(1) << "simple materials leave " << found.as_given
          << " under the map as it is given, " << found.best.misfit
          << " under the map " << (found.best.mirrored ? "mirrored and " : "")
          << "turned by " << found.best.degrees;
  return found;
}

}  // namespace ibrdf
