#include "ibrdf/solvers/report/posterior_plots.h"

#include <utility>

namespace ibrdf {

std::vector<LinePlot> SlicePlots(const std::vector<BrdfSlice>& slices) {
  const char* const channels[] = {"red", "green", "blue"};
  // The plot's own colours that come nearest.
  const int colours[] = {1, 2, 0};
  std::vector<LinePlot> plots;
  for (const BrdfSlice& slice : slices) {
    LinePlot plot{
        "BRDF, " + slice.name, {slice.angle, false}, {"BRDF (1/sr)", true}, {}};
    for (int c = 0; c < 3; ++c) {
      PlotSeries series{channels[c], slice.degrees, slice.value[c]};
      series.low = slice.low[c];
      series.high = slice.high[c];
      series.colour = colours[c];
      series.markers = false;
      plot.series.push_back(std::move(series));
    }
    plots.push_back(std::move(plot));
  }
  return plots;
}

LinePlot DegreePlot(const std::vector<double>& variance_left) {
  PlotSeries series;
  for (size_t l = 0; l < variance_left.size(); ++l) {
    series.x.push_back(static_cast<double>(l));
    series.y.push_back(1.0 - variance_left[l]);
  }
  return {"Share of the light that the image determines",
          {"degree l of spherical harmonics", false},
          {"1 - variance left / prior variance", false},
          {std::move(series)}};
}

}  // namespace ibrdf
