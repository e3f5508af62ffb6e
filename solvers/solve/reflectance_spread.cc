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
// Means over two models have: what no spread shows, as lobes cannot render it;
// the spread's share; and the 90th percentile over the median.
constexpr double kUnseen = 0.35;
constexpr double kSpreadShare = 0.55;
constexpr double kMostOverMedian = 1.8;
// Under a known light: the spread's share, and how a misfit of radiance that
// neighbours share becomes an error of the BRDF.
constexpr double kKnownLightSpread = 0.55;
constexpr double kPerMisfit = 12.0;
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

ErrorToExpect ExpectError(const Solution& solution) {
  if (std::isfinite(solution.structured_misfit)) {
    const double median = std::hypot(kKnownLightSpread * solution.spread,
                                     kPerMisfit * solution.structured_misfit);
    return {median, kKnownLightMost * median};
  }
  if (solution.models.size() < 2) return ExpectError(solution.spread);
  const double median = std::hypot(kUnseen, kSpreadShare * solution.spread);
  return {median, kMostOverMedian * median};
}

}  // namespace ibrdf
