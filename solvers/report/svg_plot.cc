#include "ibrdf/solvers/report/svg_plot.h"

#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/readable_numbers.h"

namespace ibrdf {
namespace {

// User units of the drawing.
constexpr double kWidth = 680, kHeight = 340;
constexpr double kLeft = 74, kRight = 16, kBottom = 50;
constexpr double kTitleLine = 24, kLegendLine = 19;
constexpr double kLetter = 6.6;  // mean width of the legend's letters
constexpr double kMarker = 3.2;

// Their middling lightness is readable on white and on black.
constexpr std::array<const char*, 5> kColours = {
    "#2f7fc1", "#d2691e", "#2f9460", "#a463c4", "#8c8c3c"};

std::string TickLabel(double value, double step) {
  const double largest = std::max(std::fabs(value), step);
  if (largest >= 1e6 || step < 1e-4) return Format("%g", value);
  const int decimals =
      std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return Format("%.*f", decimals, value);
}

std::vector<AxisTick> LinearTicks(double low, double high) {
  const double step = RoundUp((high - low) / 6.0);
  std::vector<AxisTick> ticks;
  const double slack = 1e-9 * step;
  const double first = std::ceil((low - slack) / step);
  for (int i = 0; i < 10; ++i) {
    const double n = first + i;
    const double value = n == 0.0 ? 0.0 : n * step;
    if (value > high + slack) break;
    ticks.push_back({value, TickLabel(value, step)});
  }
  return ticks;
}

std::vector<AxisTick> LogTicks(double low, double high) {
  const double decades = std::log10(high / low);
  if (decades < 0.75) return LinearTicks(low, high);
  const std::vector<double> factors =
      decades <= 2.5 ? std::vector<double>{1, 2, 5} : std::vector<double>{1};
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / 8.0)));
  std::vector<AxisTick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int e = first; e <= last; ++e) {
    if (((e % stride) + stride) % stride != 0) continue;
    for (const double factor : factors) {
      const double value = factor * std::pow(10.0, e);
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      ticks.push_back({value, Format("%g", value)});
    }
  }
  return ticks;
}

// From values to drawing units along one axis.
class Scale {
 public:
  Scale(double low, double high, bool logarithmic, double from, double to)
      : logarithmic_(logarithmic),
        low_(In(low)),
        span_(In(high) - low_),
        from_(from),
        to_(to) {}
  double operator()(double value) const {
    return from_ + (to_ - from_) * (In(value) - low_) / span_;
  }

 private:
  double In(double value) const {
    return logarithmic_ ? std::log10(value) : value;
  }
  bool logarithmic_;
  double low_, span_, from_, to_;
};

bool Shown(double value, const PlotAxis& axis) {
  // Beyond this, ranges and steps would overflow.
  constexpr double kLargest = 1e300;
  return std::isfinite(value) && std::fabs(value) < kLargest &&
         (!axis.logarithmic || value > 1.0 / kLargest);
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // With room at both ends, and never empty.
  void Pad(bool logarithmic) {
    if (logarithmic) {
      const double room =
          high / low < 1.0 + 1e-9 ? 2.0 : std::pow(high / low, 0.05);
      low /= room;
      high *= room;
      return;
    }
    const double magnitude = std::max(std::fabs(low), std::fabs(high));
    const double span = high - low;
    const double room =
        span > 1e-9 * magnitude ? 0.05 * span : std::max(0.5 * magnitude, 0.5);
    // Time and other quantities that cannot be negative start at zero.
    low = low >= 0.0 && low < room ? 0.0 : low - room;
    high += room;
  }
};

std::string Text(double x, double y, const char* anchor, double size,
                 const std::string& text, const std::string& more = "") {
  return Format(
             "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" "
             "font-size=\"%.0f\" fill=\"currentColor\"",
             x, y, anchor, size) +
         more + ">" + EscapeHtml(text) + "</text>\n";
}

std::string Marker(size_t kind, double x, double y, const char* colour) {
  const double r = kMarker;
  switch (kind % 4) {
    case 0:
      return Format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\" />",
                    x, y, r, colour);
    case 1:
      return Format(
          "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" "
          "height=\"%.1f\" fill=\"%s\" />",
          x - r, y - r, 2 * r, 2 * r, colour);
    case 2:
      return Format(
          "<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fZ\" "
          "fill=\"%s\" />",
          x, y - 1.3 * r, x + 1.2 * r, y + r, x - 1.2 * r, y + r, colour);
    default:
      return Format(
          "<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fL%.1f %.1fZ\" "
          "fill=\"%s\" />",
          x, y - 1.4 * r, x + 1.4 * r, y, x, y + 1.4 * r, x - 1.4 * r, y,
          colour);
  }
}

const char* Colour(const LinePlot& plot, size_t index) {
  const int colour = plot.series[index].colour;
  return kColours[(colour < 0 ? index : static_cast<size_t>(colour)) %
                  kColours.size()];
}

// Rows of names below the title; `bottom` receives where they end.
std::string Legend(const LinePlot& plot, double* bottom) {
  std::string out;
  double x = kLeft, y = kTitleLine + 14;
  for (size_t s = 0; s < plot.series.size(); ++s) {
    const std::string& name = plot.series[s].name;
    if (name.empty()) continue;
    const double width = 20 + kLetter * static_cast<double>(name.size());
    if (x > kLeft && x + width > kWidth - kRight) {
      x = kLeft;
      y += kLegendLine;
    }
    out += Marker(s, x + 5, y - 4, Colour(plot, s)) +
           Text(x + 14, y, "start", 12, name);
    x += width + 10;
  }
  *bottom = out.empty() ? kTitleLine + 8 : y + 10;
  return out;
}

std::string Axes(const LinePlot& plot, const Extent& xs, const Extent& ys,
                 const Scale& to_x, const Scale& to_y, double top) {
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  std::string out;
  const auto line = [&](double x0, double y0, double x1, double y1,
                        const char* opacity) {
    out += Format(
        "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" "
        "stroke=\"currentColor\" stroke-opacity=\"%s\" />\n",
        x0, y0, x1, y1, opacity);
  };
  for (const AxisTick& tick : AxisTicks(xs.low, xs.high, plot.x.logarithmic)) {
    const double x = to_x(tick.value);
    line(x, top, x, bottom, "0.15");
    out += Text(x, bottom + 17, "middle", 12, tick.label);
  }
  for (const AxisTick& tick : AxisTicks(ys.low, ys.high, plot.y.logarithmic)) {
    const double y = to_y(tick.value);
    line(kLeft, y, right, y, "0.15");
    out += Text(kLeft - 7, y + 4, "end", 12, tick.label);
  }
  line(kLeft, bottom, right, bottom, "0.8");
  line(kLeft, top, kLeft, bottom, "0.8");
  out += Text((kLeft + right) / 2, kHeight - 10, "middle", 13, plot.x.label);
  const double middle = (top + bottom) / 2;
  out += Text(16, middle, "middle", 13, plot.y.label,
              Format(" transform=\"rotate(-90 16 %.1f)\"", middle));
  return out;
}

// Whether a point of a series has both ends of its band.
bool HasBand(const LinePlot& plot, const PlotSeries& series, size_t i) {
  return !series.low.empty() && Shown(series.x[i], plot.x) &&
         Shown(series.low[i], plot.y) && Shown(series.high[i], plot.y);
}

// The band of a series, in pieces where a point has none.
std::string Band(const LinePlot& plot, size_t index, const Scale& to_x,
                 const Scale& to_y) {
  const PlotSeries& series = plot.series[index];
  std::string out;
  for (size_t first = 0; first < series.x.size();) {
    size_t end = first;
    while (end < series.x.size() && HasBand(plot, series, end)) ++end;
    std::string path;
    for (size_t i = first; i < end; ++i) {
      path += Format("%c%.1f %.1f", i == first ? 'M' : 'L', to_x(series.x[i]),
                     to_y(series.high[i]));
    }
    for (size_t i = end; i > first; --i) {
      path +=
          Format("L%.1f %.1f", to_x(series.x[i - 1]), to_y(series.low[i - 1]));
    }
    if (!path.empty()) {
      out += "<path d=\"" + path + "Z\" fill=\"" + Colour(plot, index) +
             "\" fill-opacity=\"0.18\" stroke=\"none\" />\n";
    }
    first = end + 1;
  }
  return out;
}

std::string Line(const LinePlot& plot, size_t index, const Scale& to_x,
                 const Scale& to_y) {
  const PlotSeries& series = plot.series[index];
  const char* const colour = Colour(plot, index);
  std::string path, markers;
  bool drawing = false;
  for (size_t i = 0; i < series.x.size(); ++i) {
    if (!Shown(series.x[i], plot.x) || !Shown(series.y[i], plot.y)) {
      drawing = false;
      continue;
    }
    const double x = to_x(series.x[i]), y = to_y(series.y[i]);
    path += Format("%c%.1f %.1f", drawing ? 'L' : 'M', x, y);
    if (series.markers) markers += Marker(index, x, y, colour) + "\n";
    drawing = true;
  }
  if (path.empty()) return "";
  return "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colour +
         "\" stroke-width=\"1.8\" />\n" + markers;
}

}  // namespace

std::vector<AxisTick> AxisTicks(double low, double high, bool logarithmic) {
  CHECK(std::isfinite(low) && std::isfinite(high) && low < high);
  CHECK(!logarithmic || low > 0.0);
  return logarithmic ? LogTicks(low, high) : LinearTicks(low, high);
}

std::string SvgLinePlot(const LinePlot& plot) {
  Extent xs, ys;
  int left_out = 0;
  for (const PlotSeries& series : plot.series) {
    CHECK_EQ(series.x.size(), series.y.size()) << series.name;
    CHECK_EQ(series.low.size(), series.high.size()) << series.name;
    CHECK(series.low.empty() || series.low.size() == series.x.size());
    for (size_t i = 0; i < series.x.size(); ++i) {
      if (HasBand(plot, series, i)) {
        ys.Add(series.low[i]);
        ys.Add(series.high[i]);
      }
      if (Shown(series.x[i], plot.x) && Shown(series.y[i], plot.y)) {
        xs.Add(series.x[i]);
        ys.Add(series.y[i]);
      } else if (!std::isnan(series.x[i])) {
        ++left_out;
      }
    }
  }
  std::string out = Format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f "
      "%.0f\" role=\"img\" font-family=\"sans-serif\">\n",
      kWidth, kHeight);
  out += "<title>" + EscapeHtml(plot.title) + "</title>\n";
  out += Text(kLeft, 18, "start", 15, plot.title, " font-weight=\"600\"");
  if (xs.low > xs.high) {
    return out +
           Text(kWidth / 2, kHeight / 2, "middle", 14, "nothing to plot") +
           "</svg>\n";
  }
  xs.Pad(plot.x.logarithmic);
  ys.Pad(plot.y.logarithmic);
  double top = 0.0;
  out += Legend(plot, &top);
  if (left_out > 0) {
    out +=
        Text(kWidth - kRight, 18, "end", 12,
             std::to_string(left_out) + (left_out == 1 ? " value" : " values") +
                 " cannot be shown");
  }
  const Scale to_x(xs.low, xs.high, plot.x.logarithmic, kLeft, kWidth - kRight);
  const Scale to_y(ys.low, ys.high, plot.y.logarithmic, kHeight - kBottom, top);
  out += Axes(plot, xs, ys, to_x, to_y, top);
  for (size_t s = 0; s < plot.series.size(); ++s) {
    out += Band(plot, s, to_x, to_y);
  }
  for (size_t s = 0; s < plot.series.size(); ++s) {
    out += Line(plot, s, to_x, to_y);
  }
  return out + "</svg>\n";
}

std::string HtmlPlots(const std::vector<LinePlot>& plots) {
  std::string out = "<div class=\"plots\">\n";
  for (const LinePlot& plot : plots) {
    out += "<div class=\"plot\">\n" + SvgLinePlot(plot) + "</div>\n";
  }
  return out + "</div>\n";
}

}  // namespace ibrdf
