#include "ibrdf/solvers/solve/joint.h"

#include <glog/logging.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/optimum_average.h"
#include "ibrdf/solvers/solve/joint_turns.h"
#include "ibrdf/solvers/solve/other_model.h"
#include "ibrdf/solvers/solve/residual_statistics.h"
#include "ibrdf/solvers/solve/summary.h"

namespace ibrdf {
namespace {

// A second search is worth its time above this spread of the first one's
// posterior: a factor of e^1.5 between probable reflectances. Of 100 held-out
// images one is above, by a search that was led astray; the next has 1.2
// (docs/notes/search.md).
constexpr double kWideOpen = 1.5;
// It takes as long as the first, which ends before this share of the time; the
// rest is the map's.
constexpr double kSecondSearchFits = 0.4;

bool IsWideOpen(const std::vector<ModelOptima>& found,
                const OptimumAverage& average) {
  const double spread = SpreadOf(*found[average.model].setup,
                                 average.estimate.lobes, average.estimate);
  VLOG(1) << "the search's posterior has a spread of " << spread;
  return spread > kWideOpen;
}

// average: set where the first search was averaged and is the only one.
SearchAgain SecondSearchOf(SolverSearch search, const SolveContext& context,
                           std::optional<OptimumAverage>* average) {
  switch (search) {
    case SolverSearch::kStandard:
      return {};
    case SolverSearch::kThorough:
      return [](const std::vector<ModelOptima>&) { return true; };
    case SolverSearch::kAuto:
      break;
  }
  return [&context, average](const std::vector<ModelOptima>& found) {
    if (!(context.Elapsed() < kSecondSearchFits * context.budget())) {
      return false;
    }
    *average = AverageOptima(found);
    if (!IsWideOpen(found, **average)) return false;
    average->reset();
    return true;
  };
}

// The models by name, the one that the lobes are of first.
void NameModels(const std::vector<ModelOptima>& searches,
                const OptimumAverage& average, Solution* solution) {
  for (size_t m = 0; m < searches.size(); ++m) {
    const InverseProblem& problem = *searches[m].setup->problem;
    const auto at = static_cast<std::ptrdiff_t>(
        m == average.model ? 0 : solution->models.size());
    solution->models.insert(solution->models.begin() + at,
                            {problem.model_name, problem.model});
    solution->model_weights.insert(solution->model_weights.begin() + at,
                                   average.model_weights[m]);
  }
}

}  // namespace

StatusOr<Solution> SolveJoint(const SolveSetup& setup, SolveContext* context) {
  const InverseProblem& problem = *setup.problem;
  std::vector<const SolveSetup*> setups = {&setup};
  std::vector<OtherModel> others;
  if (problem.solver.max_iterations > 0) {
    for (const NamedModel& model : problem.other_models) {
      StatusOr<OtherModel> other = SetUpWith(model, problem);
      if (!other.ok()) return other.status();
      others.push_back(*std::move(other));
      setups.push_back(others.back().setup.get());
    }
  }
  std::optional<OptimumAverage> of_first;
  const StatusOr<std::vector<ModelOptima>> searches = EstimateReflectances(
      setups, context,
      SecondSearchOf(problem.solver.search, *context, &of_first));
  if (searches.status().code() == StatusCode::kNoImprovement) {
    LOG(WARNING) << searches.status().message();
    return Summarise(setup, ConstantLight(setup, MeanMaterial(setup)), context);
  }
  if (!searches.ok()) return searches.status();
  OptimumAverage average =
      of_first.has_value() ? *std::move(of_first) : AverageOptima(*searches);
  const SolveSetup& found = *(*searches)[average.model].setup;
  JointTurns turns((*searches)[average.model], context);
  StatusOr<Estimate> estimate = EstimateLight(
      found, std::move(average.estimate), context,
      [&turns](const Estimate& so_far) { return turns.Take(so_far); });
  if (!estimate.ok()) return estimate.status();
  Solution solution = Summarise(found, *std::move(estimate), context);
  NameModels(*searches, average, &solution);
  if (solution.status.code() != StatusCode::kNoImprovement) {
    solution.structured_misfit =
        ResidualStatisticsOf(found, solution.render).Structured();
  }
  return solution;
}

NamedModel ModelOf(const InverseProblem& problem, const Solution& solution) {
  return solution.models.empty() ? NamedModel{problem.model_name, problem.model}
                                 : solution.models.front();
}

InverseProblem WithModelOf(const Solution& solution, InverseProblem problem) {
  NamedModel model = ModelOf(problem, solution);
  return WithModel(std::move(model), std::move(problem));
}

}  // namespace ibrdf
