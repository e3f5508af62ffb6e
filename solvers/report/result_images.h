// Images that follow from a problem and its solution.
#pragma once
#include "ibrdf/image/image.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// The pixels that a solution renders.
Mask ObjectMask(const InverseProblem& inverse);

// The pixels that a solution is judged by: those whose radiance is known in all
// three channels, from one side at least.
Mask UsedMask(const InverseProblem& inverse);

// The image; where it bounds radiance alone, what is in the bounds and nearest
// to the render.
Image NearestObserved(const InverseProblem& inverse, const Solution& solution);

// log(L_o + epsilon) - log(I + epsilon) with the likelihood's epsilon, I of
// NearestObserved; 0
// outside the object and where the pixel took no part, because other programs
// sum over the file.
Image LogResidual(const InverseProblem& inverse, const Solution& solution);

}  // namespace ibrdf
