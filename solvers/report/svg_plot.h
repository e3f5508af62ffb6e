// Line plots as SVG, to stand in an HTML page.
#pragma once
#include <string>
#include <vector>

namespace ibrdf {

struct PlotAxis {
  std::string label;  // with its unit, in any characters
  bool logarithmic = false;
};

// A value that is not finite (or, on a logarithmic axis, not positive) is left
// out and breaks the line; the plot says how many were. Where x is NaN the line
// was meant to break: such points are not counted.
struct PlotSeries {
  std::string name;
  std::vector<double> x, y;  // of one length
  // Ends of a band around y, of its length; or both empty.
  std::vector<double> low = {}, high = {};
  int colour = -1;  // of the plot's five; -1: its place among the series
  bool markers = true;
};

struct LinePlot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotSeries> series;  // told apart by colour and marker
};

struct AxisTick {
  double value = 0.0;
  std::string label;
};

// Round values within [low, high], finite, low < high, 0 < low if logarithmic;
// increasing, two to ten of them: 1, 2 or 5 times a power of ten apart, or
// decades (of some, with 2 and 5 times between them).
std::vector<AxisTick> AxisTicks(double low, double high, bool logarithmic);

// An <svg> element, well-formed XML; axes and text take the page's text colour.
// Without a value to show it says so.
std::string SvgLinePlot(const LinePlot& plot);

// Plots side by side, as the report's style has them.
std::string HtmlPlots(const std::vector<LinePlot>& plots);

}  // namespace ibrdf
