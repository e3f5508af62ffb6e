// Units of radiance: an estimate must not depend on them.
#pragma once
#include "ibrdf/solvers/solve/solve.h"

namespace ibrdf {

// The power of two nearest to the geometric mean of the pixels that can be
// used; 1 where there is none. A power of two: division by it rounds nothing.
double ExposureOf(const InverseProblem& problem);

// The same problem with radiance (image, known map, ambient
// term, epsilon) in units of
// `exposure`, so that logarithms stay near 0 and floats near 1. Quotients
// beyond the range of float become its largest.
InverseProblem InUnitsOf(double exposure, const InverseProblem& problem);

// Back to the problem's units: map, render, ambient term and epsilon. Clamped
// alike.
void RestoreUnits(double exposure, Solution* estimate);

}  // namespace ibrdf
