// The end of a solve: the estimate at every pixel, held against its reference.
#pragma once
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// Seconds that Summarise and what follows it will take, from the time of a
// transport of few pixels; at most a share of the time that remains, so that
// there is something to summarise.
double PredictSummarySeconds(const SolveSetup& setup,
                             const SolveContext& context);

// A reflectance's table, the spread of its posterior and the other candidates.
// setup: of an unknown reflectance; lobes: as LobeModel's.
MaterialSolution SummariseReflectance(const SolveSetup& setup,
                                      const std::vector<double>& lobes,
                                      const ReflectanceEstimate& reflectance);

// Renders every pixel, evaluates cost and misfit and, of the reflectance, the
// table, the spread of its posterior and the other candidates. Where the
// estimate's cost is not below the reference's, the reference is the solution,
// with the status kNoImprovement.
Solution Summarise(const SolveSetup& setup, Estimate estimate,
                   SolveContext* context);

}  // namespace ibrdf
