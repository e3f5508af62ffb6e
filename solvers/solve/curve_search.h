// The response curve of a photograph, found with the light and the reflectance
// that explain it.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// The best curve of each family of problem.unknown_curve, the best first.
//
// Curves compare by the probability of the codes: light is integrated out and
// reflectance at its mode, at the coarse resolution of the search; under known
// light the likelihood's scale is at its mode too. A curve that squeezes many
// radiances into a code gains nothing by it, as the probability of each code
// falls with its interval. A parameter is found on a line of 2 deviations of
// its prior either way, refined where the parabola through the best three
// points is lowest; its curvature gives the deviation.
//
// kNoImprovement where no curve has a finite cost. Each evaluation is a stage
// of the trace; once the context stops, the best so far counts.
StatusOr<std::vector<CurveEstimate>> FindCurves(const InverseProblem& problem,
                                                SolveContext* context);

// The problem with image and bounds by this curve.
InverseProblem WithCurve(const InverseProblem& problem,
                         const ResponseDefinition& curve);

struct LineSearch {
  double low = 0.0, high = 0.0;
  std::vector<double> starts;  // within those
  int refinements = 0;         // at most
  double settled = 0.0;
};
// `count` of them, at least two, in equal steps from low to high.
std::vector<double> EqualSteps(double low, double high, int count);

// The lowest point of a function on [low, high]: values at the starts, then at
// the vertex of the parabola through the lowest and its neighbours, until it is
// within `settled` of the lowest. Where that parabola has no lowest point and
// the function falls to an end of the starts, the end of the line is tried.
// Infinite values are passed over.
struct LineMinimum {
  double at = 0.0, value = 0.0;
  double curvature = 0.0;  // second derivative there; 0: an end is lowest
};
LineMinimum MinimiseOnLine(const std::function<double(double)>& f,
                           const LineSearch& line);

}  // namespace ibrdf
