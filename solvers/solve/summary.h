// The end of a solve: the estimate at every pixel, held against its reference.
#pragma once
#include <vector>

#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// Seconds that Summarise and what follows it will take, from the time of a
// transport of few pixels; at most a share of the time that remains, so that
// there is something to summarise.
double PredictSummarySeconds(const SolveSetup& setup,
                             const SolveContext& context);

// The spread of the posterior of a reflectance around `lobes`, between its
// optima too (reflectance_spread.h); NaN without a covariance.
double SpreadOf(const SolveSetup& setup, const std::vector<double>& lobes,
                const ReflectanceEstimate& reflectance);

// A reflectance's table, the spread of its posterior and the other candidates.
// setup: of an unknown reflectance; lobes: as LobeModel's.
MaterialSolution SummariseReflectance(const SolveSetup& setup,
                                      const std::vector<double>& lobes,
                                      const ReflectanceEstimate& reflectance);

// What is to be rendered under the solution's map too, and where to [pixels *
// 3]: a second pass over all pixels would cost as much again.
struct BesideRender {
  MaterialGrids brdfs;
  std::vector<double>* radiance = nullptr;
};

// Renders every pixel, evaluates cost and misfit and, of the reflectance, the
// table, the spread of its posterior and the other candidates. Where the
// estimate's cost is not below the reference's, the reference is the solution,
// with the status kNoImprovement.
Solution Summarise(const SolveSetup& setup, Estimate estimate,
                   SolveContext* context,
                   const std::vector<BesideRender>& beside = {});

}  // namespace ibrdf
