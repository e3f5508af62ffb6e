// What a posterior leaves open, as plots.
#pragma once
#include <vector>

#include "ibrdf/solvers/estimation/brdf_slice.h"
#include "ibrdf/solvers/report/svg_plot.h"

namespace ibrdf {

// A plot a slice: red, green and blue in 1/sr, each with its band.
std::vector<LinePlot> SlicePlots(const std::vector<BrdfSlice>& slices);

// The share of the prior's variance that is determined, by degree l = 0, 1, ...
// variance_left: of the light, not empty.
LinePlot DegreePlot(const std::vector<double>& variance_left);

}  // namespace ibrdf
