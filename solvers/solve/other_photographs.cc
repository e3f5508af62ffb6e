#include "ibrdf/solvers/solve/other_photographs.h"

#include <utility>

#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/problem/of_photograph.h"
#include "ibrdf/solvers/solve/summary.h"

namespace ibrdf {

StatusOr<std::vector<LitPhotograph>> OtherPhotographsOf(
    const InverseProblem& problem) {
  std::vector<LitPhotograph> out;
  for (size_t k = 0; k < problem.other_photographs.size(); ++k) {
    LitPhotograph one;
    one.name = "photograph " + std::to_string(k + 2);
    one.problem = OfPhotograph(problem, k);
    const StatusOr<SolveSetup> setup = SetUp(one.problem);
    if (!setup.ok()) {
      return InvalidInput(problem.other_photographs[k]->file,
                          setup.status().message());
    }
    one.observed = setup->pixels.observed;
    out.push_back(std::move(one));
  }
  return out;
}

Status FindOtherLight(const UnpaintedReflectance& reflectance,
                      const std::vector<double>& gain,
                      const SolveContext& context, LitPhotograph* photograph) {
  InverseProblem without =
      WithoutPaint(photograph->problem, gain, photograph->problem.points);
  without.known_brdf = reflectance.whole;
  without.estimated_brdfs = {reflectance.whole};
  without.seconds_spent = context.Elapsed();
  const StatusOr<SolveSetup> setup = SetUp(without);
  if (!setup.ok()) return setup.status();
  const SolveProgress progress = [&](TraceEntry entry, double share) {
    entry.stage.insert(0, photograph->name + ": ");
    if (context.progress()) context.progress()(entry, share);
  };
  SolveContext own(without, progress, context.stop());
  own.Reserve(context.reserved());
  ReflectanceEstimate known;
  known.light = EstimateLightPosterior(*setup, &own);
  StatusOr<Estimate> estimate = EstimateLight(*setup, std::move(known), &own);
  if (!estimate.ok()) return estimate.status();
  Solution solution =
      Summarise(*setup, *std::move(estimate), &own,
                UnpaintedRenders(reflectance, &photograph->unpainted));
  TakeMatteOff(&photograph->unpainted);
  photograph->light = {std::move(solution.map), std::move(solution.render),
                       solution.misfit};
  return OkStatus();
}

}  // namespace ibrdf
