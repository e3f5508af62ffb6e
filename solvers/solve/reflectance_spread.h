// How far apart the reflectances are that a posterior deems probable.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/solvers/estimation/solution.h"

namespace ibrdf {

// Log-RMSE between lobes as CompareBrdfs has it of their tables, but over some
// thousands of nodes, each with the share of bins around it. Immutable.
class LobeDistance {
 public:
  static constexpr BrdfGridShape kMetricGrid = {36, 16, 24};

  // A coarser grid is quicker and less exact.
  explicit LobeDistance(const LobeFactory& lobes,
                        const BrdfGridShape& grid = kMetricGrid);

  const LobeModel& lobes() const { return *lobes_; }
  // Log of raw values plus the metric's floor, [3][nodes].
  std::vector<double> LogValues(const std::vector<double>& parameters) const;
  // The distance of two such after the best scale of each channel.
  double Aligned(const std::vector<double>& a,
                 const std::vector<double>& b) const;
  // The distance of two such as they are.
  double WithLevel(const std::vector<double>& a,
                   const std::vector<double>& b) const;
  // Mean of a less b, by channel: the log of the best scale of b.
  Eigen::Array3d MeanDifference(const std::vector<double>& a,
                                const std::vector<double>& b) const;

 private:
  // If `aligned`, each channel's mean difference is taken off first.
  double Distance(const std::vector<double>& a, const std::vector<double>& b,
                  bool aligned) const;

  std::unique_ptr<const LobeModel> lobes_;
  std::vector<double> weights_;  // [nodes], sum 1
};

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
// The same for a solution. The spread of a mean over the optima of two models
// has what they disagree in, and a small one says little: sqrt(0.35^2 + (0.55
// spread)^2) and 1.8 times that, by 22 held-out cases
// (docs/notes/averaged_optima.md). Under a known light, where the error is that
// of the level too, it is sqrt((0.55 spread)^2 + (12 structured_misfit)^2) and
// 1.6 times that, by 50 held-out cases (docs/notes/known_light.md).
ErrorToExpect ExpectError(const Solution& solution);

}  // namespace ibrdf
