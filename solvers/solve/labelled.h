// The solve of an object whose materials are labelled.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// Unknown reflectances of several materials, two labels or more. Under unknown
// light they share it: their reflectances together with the light integrated
// out, then the light given those. Under a known light each is a problem of its
// own, where light that bounces is taken to come from its own material.
StatusOr<Solution> SolveLabelled(const SolveSetup& setup,
                                 SolveContext* context);

}  // namespace ibrdf
