// The reflectance under known light of an object whose albedo varies.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// f = a(x) f_matte + f_gloss, a > 0 of three channels, as in SolvePainted. The
// shading of a matte object under the map gives a first paint; then the
// reflectance is found from the image with its paint divided out, and the paint
// under that reflectance, in turns. As the light is known, all of the image's
// colour that is not gloss is the paint's.
StatusOr<Solution> SolvePaintedUnderKnownLight(const SolveSetup& setup,
                                               SolveContext* context);

}  // namespace ibrdf
