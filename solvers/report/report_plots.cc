#include "ibrdf/solvers/report/report_plots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ibrdf {
namespace {

constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
const PlotAxis kSeconds = {"time (s)", false};

// The search compares normal-binned pixels under light that is integrated out;
// it has no scale.
bool IsSearch(const TraceEntry& entry) { return !(entry.scale > 0.0); }

// Lines whose misfits and costs compare.
std::string StageName(const TraceEntry& entry) {
  if (IsSearch(entry)) return "search, light integrated out";
  return std::to_string(entry.pixels) + " pixels";
}

// The series of that name, made at first use.
PlotSeries* SeriesNamed(const std::string& name, LinePlot* plot) {
  for (PlotSeries& series : plot->series) {
    if (series.name == name) return &series;
  }
  plot->series.push_back({name, {}, {}});
  return &plot->series.back();
}

void Append(const std::string& name, double x, double y, LinePlot* plot) {
  PlotSeries* const series = SeriesNamed(name, plot);
  series->x.push_back(x);
  series->y.push_back(y);
}

bool AnyPositive(const PlotSeries& series) {
  return std::any_of(series.y.begin(), series.y.end(),
                     [](double y) { return std::isfinite(y) && y > 0.0; });
}

bool AnyFinite(const PlotSeries& series) {
  return std::any_of(series.y.begin(), series.y.end(),
                     [](double y) { return std::isfinite(y); });
}

LinePlot MisfitPlot(const std::vector<TraceEntry>& trace) {
  LinePlot plot{"Misfit: mean absolute log error",
                kSeconds,
                {"mean |log L_o - log I| (natural log)", true},
                {}};
  for (const TraceEntry& entry : trace) {
    Append(StageName(entry), entry.seconds, entry.misfit, &plot);
  }
  return plot;
}

// One curve for each step of the search: coarse and fine ones differ in their
// number of bins.
LinePlot SearchPlot(const std::vector<TraceEntry>& trace) {
  LinePlot plot{"Search: -log posterior with the light integrated out",
                kSeconds,
                {"cost (nats)", false},
                {}};
  for (const TraceEntry& entry : trace) {
    if (!IsSearch(entry)) continue;
    const std::string step = entry.stage.substr(0, entry.stage.find(' '));
    Append(step, entry.seconds, entry.cost, &plot);
  }
  return plot;
}

LinePlot TermsPlot(const std::vector<TraceEntry>& trace) {
  LinePlot plot{
      "Terms of the cost at the pixels", kSeconds, {"cost (nats)", true}, {}};
  std::string last_stage;
  for (const TraceEntry& entry : trace) {
    if (IsSearch(entry)) continue;
    const std::string stage = StageName(entry);
    const bool breaks = !last_stage.empty() && stage != last_stage;
    const auto append = [&](const char* name, double value) {
      if (breaks) Append(name, kBreak, kBreak, &plot);
      Append(name, entry.seconds, value, &plot);
    };
    append("sum", entry.cost);
    append("likelihood", entry.likelihood);
    append("prior of the reflectance", entry.reflectance_prior);
    append("prior of the light", entry.illumination_prior);
    last_stage = stage;
  }
  return plot;
}

}  // namespace

std::vector<LinePlot> TracePlots(const std::vector<TraceEntry>& trace) {
  std::vector<LinePlot> plots;
  for (LinePlot plot :
       {MisfitPlot(trace), SearchPlot(trace), TermsPlot(trace)}) {
    // A term that the problem does not have is zero throughout.
    const auto shown = plot.y.logarithmic ? AnyPositive : AnyFinite;
    plot.series.erase(
        std::remove_if(plot.series.begin(), plot.series.end(),
                       [&](const PlotSeries& s) { return !shown(s); }),
        plot.series.end());
    if (!plot.series.empty()) plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace ibrdf
