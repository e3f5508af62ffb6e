// The methods of the sweep `merl-fit` that need no trained weights.
#pragma once
#include <vector>

#include "ibrdf/solvers/bench/table_fitter.h"

namespace ibrdf {

// bivariate, bivariate_arithmetic, lambertian, cook_torrance, disney, and
// dsbrdf with each of these numbers of lobes (three as published).
TableFitters BaselineFitters(const std::vector<int>& dsbrdf_lobes = {3, 5});

}  // namespace ibrdf
