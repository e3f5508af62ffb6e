// What a search for the reflectances of labelled materials begins from.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/marginal/search_options.h"

namespace ibrdf {

// A material that may be one label's.
struct LabelCandidate {
  std::string name;
  double cost = 0.0;
  Eigen::VectorXd parameters;  // as LobeModel's
  // Mean log radiance of the light that it implies; unset: none is known.
  std::optional<Eigen::Array3d> light_level;
};

// A material of each label.
struct LabelCombination {
  double cost = 0.0;  // the sum of theirs
  std::vector<LabelCandidate> materials;

  std::string Name() const;
  // The parameters of all, [materials][lobes' parameters], their colours moved
  // so that all see the mean of the lights that they imply.
  Eigen::VectorXd InOneLight(const LobeModel& lobes) const;
};

// How the search for one label by itself goes.
struct LabelSearch {
  std::vector<SearchStage> stages = {{6, 2}, {3, 4}};
  int ranked_anew = ReflectanceSearchOptions().ranked_anew;
  bool quiet = false;  // no line of the trace
  // As ReflectanceSearchOptions has it; empty: once time is up.
  std::function<bool()> should_stop = {};
};

// The best three materials of a label by itself, under a light of its own, at
// the search's coarse resolution; the most central one where its pixels tell of
// none.
std::vector<LabelCandidate> FindLabelCandidates(const SolveSetup& setup,
                                                int material,
                                                const LabelSearch& search,
                                                SolveContext* context);

// The combinations of lowest sums of costs, at most so many, the best first.
// candidates: of each label.
std::vector<LabelCombination> Combine(
    const std::vector<std::vector<LabelCandidate>>& candidates, size_t most);

}  // namespace ibrdf
