// Turns of reflectance and light after a joint search.
#pragma once
#include <memory>
#include <optional>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/solve/turns.h"

namespace ibrdf {

// The search bins pixels by normals into few bins and has a light of few
// texels. In these a mirror of one degree and one of five differ by the noise
// that light inside texels makes. A map of the problem's size tells them apart:
// while it is being found, the reflectance is found anew under it, solver.turns
// times at most, as long as the time allows and what is left of the image is
// not noise. Where pixels show detail that the map's texels cannot, the
// reflectance is found from the bins that the map is found from. Before the
// first turn, if solver.search is `thorough`, a reflectance of another kind
// that the search gave up may take the estimate's place (FindOtherKind). What
// the search says of the posterior stays.
class JointTurns {
 public:
  // found: what a search found with the model of its setup, which must outlive
  // this, as must the context.
  JointTurns(const ModelOptima& found, SolveContext* context);

  // The reflectance under the map of an estimate of both; empty: no turn is
  // worth it. As ReviseReflectance.
  StatusOr<std::optional<RevisedReflectance>> Take(const Estimate& estimate);

 private:
  bool Worthwhile(const Estimate& estimate);
  // Where the search may have been led to another kind of reflectance: that
  // one.
  StatusOr<std::optional<RevisedReflectance>> TakeOtherKind(
      const Estimate& estimate);

  const SolveSetup& setup_;
  const std::shared_ptr<const LevelGauge> gauge_;
  SolveContext* const context_;
  // What a thorough search found, until it has been asked for another kind.
  std::optional<ModelOptima> of_search_;
  Turns turns_;
  // Whether pixels show detail that the map's texels cannot; unset before the
  // first turn.
  std::optional<bool> beyond_texels_;
};

}  // namespace ibrdf
