// A problem with its solution: what result.json, the pictures and the report
// are made from.
#pragma once
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/next_view/informative_views.h"
#include "ibrdf/solvers/problem/inverse_problem.h"
#include "ibrdf/solvers/problem/truth.h"
#include "ibrdf/solvers/report/result_metrics.h"

namespace ibrdf {

// Borrows what it refers to.
struct SolvedProblem {
  const Problem& problem;         // as its file says
  const InverseProblem& inverse;  // as it was solved
  const Truth& truth;
  const Solution& solution;
  const ResultMetrics& metrics;  // MeasureResult of these
  // Which photographs to take next; null: nobody asked, or nothing says.
  const InformativeViews* next_views = nullptr;
};

}  // namespace ibrdf
