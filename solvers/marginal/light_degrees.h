// What an image determines of an unknown map, by spatial frequency.
#pragma once
#include <array>
#include <vector>

#include "ibrdf/solvers/marginal/marginal_likelihood.h"

namespace ibrdf {

// The highest degree that is told.
inline constexpr int kLightDegrees = 8;

// The share of the prior's variance that the posterior at the mode leaves of
// the harmonics of log radiance of degree l, variances summed over m and
// channels: [min(kLightDegrees, map_height / 2) + 1], each in [0, 1].
std::vector<double> VarianceLeftByDegree(
    const MarginalLikelihood& likelihood,
    const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, const LightMode& mode,
    int map_height, int map_width);

// int Y of each texel, [texels][harmonics], harmonics up to `order`.
RowMatrix HarmonicsOfTexels(int order, int map_height, int map_width);

}  // namespace ibrdf
