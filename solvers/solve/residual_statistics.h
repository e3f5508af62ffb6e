// What an estimate leaves of its image, in two numbers.
#pragma once
#include <algorithm>
#include <cmath>

#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// They are taken of the log radiance of some 2000 pixels, in whole rows that
// are spread over the image.
struct ResidualStatistics {
  double misfit = 0.0;  // mean of the absolute residuals
  // Pixels beside each other correlate by it, in [-1, 1]: noise by some 0.
  double correlation = 0.0;

  // The part of the misfit that neighbours share.
  double Structured() const {
    return misfit * std::sqrt(std::max(correlation, 0.0));
  }
};

// The setup is of the estimate's model. An image without pixels leaves 0.
ResidualStatistics ResidualStatisticsOf(const SolveSetup& setup,
                                        const Estimate& estimate);

}  // namespace ibrdf
