// The trace of a result as plots.
#pragma once
#include <vector>

#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/report/svg_plot.h"

namespace ibrdf {

// The misfit; the cost of the search for the reflectance; the terms of the cost
// at the image's pixels; all against seconds. A plot without a value is left
// out. Where the number of pixels changes, misfits are another series and the
// lines of costs break.
std::vector<LinePlot> TracePlots(const std::vector<TraceEntry>& trace);

}  // namespace ibrdf
