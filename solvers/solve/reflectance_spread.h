// How far apart the reflectances are that a posterior deems probable.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/solvers/estimation/lobe_distance.h"
#include "ibrdf/solvers/estimation/solution.h"

namespace ibrdf {

// Root mean square, over `draws` of N(parameters, covariance), of the aligned
// distance to `parameters`: what the estimate's error is if that is the
// posterior. covariance [n * n], symmetric; what rounding made negative in it
// counts as none. Codes of draws stay in the unit ball. NaN where a value is
// not finite.
double ReflectanceSpread(const LobeDistance& distance,
                         const std::vector<double>& parameters,
                         const std::vector<double>& covariance, int draws,
                         uint64_t seed);
// The same under a known light, which tells the level: the median of the
// distance as it is. Of what such an image does not show a few draws are far
// off, and a root mean square would be of these alone.
double KnownLightSpread(const LobeDistance& distance,
                        const std::vector<double>& parameters,
                        const std::vector<double>& covariance, int draws,
                        uint64_t seed);

// A posterior that takes no account of what lobes and light's statistics get
// wrong is too sure. The aligned log-RMSE that half and nine of ten problems
// whose truth is known stayed within at that spread (experiments/evidence, "How
// sure is it?").
struct ErrorToExpect {
  double median = 0.0, most = 0.0;
};
ErrorToExpect ExpectError(double spread);
// The same for a solution, which also has what the estimate does not explain.
// Of a mean over the optima of two models it is sqrt(0.1^2 + (0.6 spread)^2 +
// (12 structured_misfit)^2) and sqrt(0.15^2 + (0.9 spread)^2 +
// (36 structured_misfit)^2) (docs/notes/posterior_is_overconfident.md). Under a
// known light, where the error is that of the level too, it is
// sqrt((0.55 spread)^2 + (12 structured_misfit)^2) and 1.6 times that, by 50
// held-out cases (docs/notes/known_light.md).
ErrorToExpect ExpectError(const Solution& solution, bool light_unknown);

}  // namespace ibrdf
