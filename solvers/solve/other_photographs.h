// Photographs of a painted object under other lights than the first's.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/solve/unpainted_object.h"

namespace ibrdf {

// One of them, and what is known of its light so far.
struct LitPhotograph {
  std::string name;        // in the lines of progress
  InverseProblem problem;  // of this photograph alone
  Observations observed;   // of the problem's points
  OtherLight light;
  UnpaintedRadiance unpainted;  // under that light; empty before it is found
};

// Those of the problem, in order. kInvalidInput where one of them has no pixel
// to use.
StatusOr<std::vector<LitPhotograph>> OtherPhotographsOf(
    const InverseProblem& problem);

// Finds the light of one, the reflectance known and what paint makes of each
// pixel (PaintGain): sets `light`, its render still without paint, and
// `unpainted`. context: of the whole solve, whose trace keeps to the first
// photograph.
Status FindOtherLight(const UnpaintedReflectance& reflectance,
                      const std::vector<double>& gain,
                      const SolveContext& context, LitPhotograph* photograph);

}  // namespace ibrdf
