// What an estimate leaves of its image, in two numbers.
#pragma once
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// Of the log radiance of some 2000 pixels, whole rows spread over the image.
struct ResidualStatistics {
  double misfit = 0.0;  // mean of the absolute residuals
  // Of pixels beside each other, in [-1, 1]: that of noise is near 0.
  double correlation = 0.0;
};

// The setup is of the estimate's model. An image without pixels leaves 0.
ResidualStatistics ResidualStatisticsOf(const SolveSetup& setup,
                                        const Estimate& estimate);

}  // namespace ibrdf
