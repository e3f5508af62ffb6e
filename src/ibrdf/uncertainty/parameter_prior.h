// A prior over the cells of a grid of (alpha, Ks).
#pragma once
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

// p(psi) of Wiersma et al. 2025, Eq. 2: one number > 0 a cell, in any unit, or
// none at all, which is uniform.
Status CheckPrior(const std::vector<double>& prior, int num_cells);

// -log p, its least value 0; empty for a uniform prior.
std::vector<double> PriorPenalty(const std::vector<double>& prior);

// Counts materials with those alpha and Ks (the same number of each): how many
// are in each cell [num_alpha, num_ks] of values in increasing order, plus
// `floor` > 0, so that no cell is impossible. A material counts for the nearest
// values.
std::vector<double> PriorOfMaterials(const std::vector<double>& alpha,
                                     const std::vector<double>& Ks,
                                     const std::vector<double>& alpha_values,
                                     const std::vector<double>& Ks_values,
                                     double floor);

}  // namespace ibrdf
