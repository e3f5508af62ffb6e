// What an estimate leaves of its image, in two numbers.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// What the log radiance of some 2000 pixels lacks, in whole rows that are
// spread over the image.
struct ResidualRows {
  std::vector<size_t> indices;     // of the setup's points, row by row
  std::vector<double> log_render;  // [indices * 3]
  std::vector<double> residuals;   // likewise; 0 within an interval's ends

  double Misfit() const;  // mean of the absolute residuals; 0: no pixel
  // Residuals beyond it, outliers, count as that.
  double LargestResidual() const { return 4.0 * Misfit(); }
};

// The setup is of the estimate's model.
ResidualRows ResidualRowsOf(const SolveSetup& setup, const Estimate& estimate);

// Places in `indices`, ascending, of points whose pixels are beside each other
// in a row.
std::vector<std::pair<size_t, size_t>> PairsInRows(
    const std::vector<ShadingPoint>& points,
    const std::vector<size_t>& indices);

// Two numbers for the residuals of ResidualRows.
struct ResidualStatistics {
  double misfit = 0.0;  // mean of the absolute residuals
  // Pixels beside each other correlate by it, in [-1, 1]: noise by some 0.
  double correlation = 0.0;

  // The part of the misfit that neighbours share.
  double Structured() const {
    return misfit * std::sqrt(std::max(correlation, 0.0));
  }
};

// An image without pixels leaves 0.
ResidualStatistics ResidualStatisticsOf(const SolveSetup& setup,
                                        const Estimate& estimate);
// The same of a rendered image of the problem's size.
ResidualStatistics ResidualStatisticsOf(const SolveSetup& setup,
                                        const Image& render);

}  // namespace ibrdf
