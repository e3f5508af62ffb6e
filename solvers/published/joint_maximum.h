// The estimate as published: reflectance and light at once, the maximum of
// their joint posterior (Chen et al. 2020, Eq. 8). It stands for comparison:
// the maximum prefers gloss under blurred light
// (docs/notes/maximum_of_both.md).
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// From the mean material under the constant map that gives the image its level.
StatusOr<Estimate> EstimateJointMaximum(const SolveSetup& setup,
                                        SolveContext* context);

}  // namespace ibrdf
