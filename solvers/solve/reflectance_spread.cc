#include "ibrdf/solvers/solve/reflectance_spread.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/solvers/solve/reflectance_samples.h"

namespace ibrdf {
namespace {

// Errors over spreads: the median and the 90th percentile.
constexpr double kMedianRatio = 2.1;
constexpr double kMostRatio = 3.8;
// How a misfit of radiance that neighbours share becomes an error of the BRDF.
constexpr double kPerMisfit = 12.0;
// Means over two models: what neither shows, the spread's share, and that of
// the misfit; and the same of the 90th percentile.
constexpr double kUnseen = 0.1, kSpreadShare = 0.6;
constexpr double kMostUnseen = 0.15, kMostSpread = 0.9, kMostPerMisfit = 36.0;
// Under a known light: the spread's share, and the 90th percentile over the
// median.
constexpr double kKnownLightSpread = 0.55;
constexpr double kKnownLightMost = 1.6;

using Distance = double (LobeDistance::*)(const std::vector<double>&,
                                          const std::vector<double>&) const;

// From each sample to `parameters`. Empty where a value is not finite.
std::vector<double> SampleDistances(const LobeDistance& lobes,
                                    Distance distance,
                                    const std::vector<double>& parameters,
                                    const std::vector<double>& covariance,
                                    int draws, uint64_t seed) {
  const std::vector<double> at = lobes.LogValues(parameters);
  std::vector<double> distances;
  for (const std::vector<double>& sample :
       SampleReflectances(lobes.lobes(), parameters, covariance, draws, seed)) {
    distances.push_back((lobes.*distance)(lobes.LogValues(sample), at));
  }
  return distances;
}

}  // namespace

double ReflectanceSpread(const LobeDistance& distance,
                         const std::vector<double>& parameters,
                         const std::vector<double>& covariance, int draws,
                         uint64_t seed) {
  const std::vector<double> distances = SampleDistances(
      distance, &LobeDistance::Aligned, parameters, covariance, draws, seed);
  if (distances.empty()) return std::numeric_limits<double>::quiet_NaN();
  double squares = 0.0;
  for (const double d : distances) squares += d * d;
  return std::sqrt(squares / draws);
}

double KnownLightSpread(const LobeDistance& distance,
                        const std::vector<double>& parameters,
                        const std::vector<double>& covariance, int draws,
                        uint64_t seed) {
  std::vector<double> distances = SampleDistances(
      distance, &LobeDistance::WithLevel, parameters, covariance, draws, seed);
  if (distances.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = distances.begin() + draws / 2;
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

ErrorToExpect ExpectError(double spread) {
  return {kMedianRatio * spread, kMostRatio * spread};
}

ErrorToExpect ExpectError(const Solution& solution, bool light_unknown) {
  const double spread = solution.spread, misfit = solution.structured_misfit;
  if (!std::isfinite(misfit)) return ExpectError(spread);
  if (!light_unknown) {
    const double median =
        std::hypot(kKnownLightSpread * spread, kPerMisfit * misfit);
    return {median, kKnownLightMost * median};
  }
  if (solution.models.size() < 2) return ExpectError(spread);
  return {
      std::hypot(kUnseen, kSpreadShare * spread, kPerMisfit * misfit),
      std::hypot(kMostUnseen, kMostSpread * spread, kMostPerMisfit * misfit)};
}

}  // namespace ibrdf
