#include "ibrdf/solvers/report/report_plots.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/solvers/report/json_values.h"

namespace ibrdf {
namespace {
using Json = nlohmann::ordered_json;

constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
const PlotAxis kSeconds = {"time (s)", false};

// Lines whose misfits and costs compare. The search compares cells of pixels
// under light that is integrated out; it has no scale.
std::string StageName(const Json& entry) {
  if (!(NumberAt(entry, "scale") > 0.0)) return "search, light integrated out";
  const double pixels = NumberAt(entry, "pixels");
  if (!std::isfinite(pixels)) return "pixels";
  return std::to_string(std::llround(pixels)) + " pixels";
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

}  // namespace

std::vector<LinePlot> TracePlots(const Json& trace) {
  LinePlot misfit{
      "Misfit", kSeconds, {"mean |log E - log I| (natural log)", true}, {}};
  LinePlot search{"Search: -log posterior with the light integrated out",
                  kSeconds,
                  {"cost (nats)", false},
                  {}};
  LinePlot terms{
      "Terms of the cost at the pixels", kSeconds, {"cost (nats)", true}, {}};
  if (!trace.is_array()) return {};
  std::string last_stage;  // at the pixels
  for (const Json& entry : trace) {
    const double seconds = NumberAt(entry, "seconds");
    const std::string stage = StageName(entry);
    Append(stage, seconds, NumberAt(entry, "misfit"), &misfit);
    if (!(NumberAt(entry, "scale") > 0.0)) {
      // One curve for each step of the search: coarse and fine ones differ in
      // their number of cells.
      const std::string step = TextAt(entry, "stage");
      Append(step.substr(0, step.find(' ')), seconds, NumberAt(entry, "cost"),
             &search);
      continue;
    }
    const char* const names[][2] = {
        {"cost", "sum"},
        {"likelihood", "likelihood"},
        {"reflectance_prior", "prior of the reflectance"},
        {"illumination_prior", "prior of the light"}};
    for (const auto& name : names) {
      if (!last_stage.empty() && stage != last_stage) {
        Append(name[1], kBreak, kBreak, &terms);
      }
      Append(name[1], seconds, NumberAt(entry, name[0]), &terms);
    }
    last_stage = stage;
  }
  std::vector<LinePlot> plots;
  for (LinePlot* plot : {&misfit, &search, &terms}) {
    // A term that the problem does not have is zero throughout.
    const auto shown = plot->y.logarithmic ? AnyPositive : AnyFinite;
    plot->series.erase(
        std::remove_if(plot->series.begin(), plot->series.end(),
                       [&](const PlotSeries& s) { return !shown(s); }),
        plot->series.end());
    if (!plot->series.empty()) plots.push_back(std::move(*plot));
  }
  return plots;
}

}  // namespace ibrdf
