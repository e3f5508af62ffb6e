// The methods of the sweep `merl-fit` that need no trained weights.
#pragma once
#include "ibrdf/solvers/bench/table_fitter.h"

namespace ibrdf {

// bivariate, bivariate_arithmetic, lambertian, cook_torrance, disney, dsbrdf
// (of three lobes, as published, and of five).
TableFitters BaselineFitters();

}  // namespace ibrdf
