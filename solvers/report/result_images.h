// Images that follow from a problem and its solution.
#pragma once
#include "ibrdf/image/image.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// The pixels that a solution renders.
Mask ObjectMask(const InverseProblem& inverse);

// log(L_o + epsilon) - log(I + epsilon) with the likelihood's epsilon; 0
// outside the object and where the pixel took no part, because other programs
// sum over the file.
Image LogResidual(const InverseProblem& inverse, const Solution& solution);

}  // namespace ibrdf
