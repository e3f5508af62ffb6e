// The joint estimate of an object whose albedo varies.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// f = a(x) f_matte + f_gloss, a > 0 of three channels. The reflectance comes
// from the search in which paint is integrated out with the light; then light
// and paint are found in turns, the light from the image with its paint divided
// out. The solution's lobes are of the unpainted object, whose log albedo is
// that of a = 1; its render is of the painted one.
StatusOr<Solution> SolvePainted(const SolveSetup& setup, SolveContext* context);

}  // namespace ibrdf
