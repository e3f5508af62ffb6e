// Steps of lobes under a known light, on a coarser grid than the problem's.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/estimation/known_light_search.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/transport/reflectance_operator.h"

namespace ibrdf {

// The radiance of lobes and its derivatives cost a seventh of what they cost on
// the problem's grid, and are wrong where a lobe turns within a cell. So every
// batch of steps begins with the radiance on the problem's grid: the
// observations are multiplied by what this grid makes of that radiance. Where
// the two differ alike in all lobes nearby, the steps lead to the optimum of
// the problem's grid (defect correction: Boehmer, Hemker and Stetter 1984).
class CoarseSteps {
 public:
  // Of a setup with unknown lobes and a known light, which must outlive this.
  CoarseSteps(const SolveSetup& setup, const Observation& pixels);
  CoarseSteps(const CoarseSteps&) = delete;
  CoarseSteps& operator=(const CoarseSteps&) = delete;

  // As RankUnderKnownLight.
  std::vector<RankedMaterial> Rank(const RobustLogLikelihood& likelihood) const;

  // Of lobes at the pixels on this grid [points * 3], without an ambient term.
  std::vector<double> Radiance(const JointState& state);

  struct Options {
    int max_steps = 1;
    double radius = 1.0;  // of the trust region, at first
    double scale = 0.0;   // of the likelihood
    std::function<bool()> should_stop;
  };
  // Moves the lobes and an unknown ambient term. `fine` [points * 3] is their
  // radiance on the problem's grid, without the ambient term.
  void Take(const Options& options, const std::vector<double>& fine,
            JointState* state, Eigen::Array3d* ambient);

 private:
  const SolveSetup setup_;  // with lobes on the coarse grid
  ObservedPixels pixels_;
  const Transport& transport_;
  std::optional<ReflectanceOperator> stored_;  // of the known map
};

}  // namespace ibrdf
