#include "ibrdf/solvers/report/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/markup.h"
#include "tests/support/non_finite.h"

namespace ibrdf {
namespace {

std::string Labels(const std::vector<AxisTick>& ticks) {
  std::string out;
  for (const AxisTick& tick : ticks) {
    out += (out.empty() ? "" : " ") + tick.label;
  }
  return out;
}

size_t Count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t i = text.find(part); i != text.npos; i = text.find(part, i + 1)) {
    ++n;
  }
  return n;
}

// A band in two pieces, without markers, in the colour that is asked for.
TEST(SvgLinePlot, BandsEncloseTheirLines) {
  PlotSeries series{"blue", {0, 1, 2, 3}, {2, 3, 4, 5}};
  series.low = {1, 2, kNan, 4};
  series.high = {3, 9, 6, 6};
  series.colour = 4;
  series.markers = false;
  const std::string svg =
      SvgLinePlot({"t", {"x", false}, {"y", false}, {series}});
  EXPECT_EQ("", MarkupError(svg));
  EXPECT_EQ(2u, Count(svg, "fill-opacity"));
  EXPECT_EQ(3u, Count(svg, "#8c8c3c") - 1);  // two bands, the line; the legend
  EXPECT_EQ(1u, Count(svg, "<circle"));      // the legend's
  // The axis reaches to the band's ends.
  EXPECT_EQ(1u, Count(svg, ">8<"));
  series.low.clear();
  series.high.clear();
  EXPECT_EQ(0u, Count(SvgLinePlot({"t", {"x", false}, {"y", false}, {series}}),
                      "fill-opacity"));
}

TEST(AxisTicks, RoundNumbers) {
  EXPECT_EQ("0 10 20 30 40 50", Labels(AxisTicks(0, 52, false)));
  EXPECT_EQ("-1.0 -0.5 0.0 0.5 1.0", Labels(AxisTicks(-1, 1, false)));
  EXPECT_EQ("0.10 0.15 0.20", Labels(AxisTicks(0.1, 0.23, false)));
  EXPECT_EQ("0.01 0.02 0.05 0.1 0.2 0.5 1", Labels(AxisTicks(0.01, 1, true)));
  EXPECT_EQ("0.001 0.01 0.1 1 10 100", Labels(AxisTicks(7e-4, 300, true)));
  // Less than a decade has no decades to mark.
  EXPECT_EQ("2.0 2.5 3.0 3.5 4.0", Labels(AxisTicks(1.9, 4.2, true)));
}

TEST(AxisTicks, FewIncreasingAndWithinForAnyRange) {
  for (const bool logarithmic : {false, true}) {
    for (double low = 1e-9; low < 1e12; low *= 3.7) {
      for (double factor = 1.001; factor < 1e18; factor *= 1.9) {
        const double high = low * factor;
        const std::vector<AxisTick> ticks = AxisTicks(low, high, logarithmic);
        ASSERT_GE(ticks.size(), size_t{2}) << low << " " << high;
        ASSERT_LE(ticks.size(), size_t{10}) << low << " " << high;
        for (size_t i = 0; i < ticks.size(); ++i) {
          // 1e-8: ticks at the very ends count, whatever their rounding.
          ASSERT_GE(ticks[i].value, low - 1e-8 * high);
          ASSERT_LE(ticks[i].value, high * (1 + 1e-8));
          if (i == 0) continue;
          ASSERT_GT(ticks[i].value, ticks[i - 1].value);
          if (factor > 1.01) {
            ASSERT_NE(ticks[i].label, ticks[i - 1].label);
          }
        }
      }
    }
  }
}

// So narrow beside its distance from zero that steps vanish in rounding.
TEST(AxisTicks, EndsForRangesOfAFewUlps) {
  EXPECT_LE(AxisTicks(1e20, 1e20 + 65536, false).size(), size_t{10});
}

TEST(SvgLinePlot, WellFormedWithLabelsAndUnits) {
  const LinePlot plot{
      "Misfit <1 & \"2\"",
      {"time (s)", false},
      {"misfit", true},
      {{"a & b", {0, 1, 2}, {1, 0.1, 0.01}}, {"second", {0, 2}, {3, 4}}}};
  const std::string svg = SvgLinePlot(plot);
  EXPECT_EQ("", MarkupError(svg));
  for (const char* part : {"time (s)", ">misfit<", "a &amp; b", ">second<",
                           "Misfit &lt;1 &amp; &quot;2&quot;"}) {
    EXPECT_NE(std::string::npos, svg.find(part)) << part;
  }
  EXPECT_EQ(std::string::npos, svg.find("cannot be shown"));
}

TEST(SvgLinePlot, NothingToPlot) {
  for (const std::vector<PlotSeries>& series :
       {std::vector<PlotSeries>(), {{"a", {}, {}}}, {{"a", {1}, {kNan}}}}) {
    const std::string svg = SvgLinePlot({"t", {"x"}, {"y"}, series});
    EXPECT_EQ("", MarkupError(svg));
    EXPECT_NE(std::string::npos, svg.find("nothing to plot"));
  }
}

TEST(SvgLinePlot, OneValueAndEqualValues) {
  for (const bool logarithmic : {false, true}) {
    for (const double y : {1e-299, 3.0, 1e299}) {
      const std::string svg = SvgLinePlot(
          {"t", {"x"}, {"y", logarithmic}, {{"a", {5, 5}, {y, y}}}});
      EXPECT_EQ("", MarkupError(svg));
      EXPECT_EQ(size_t{3}, Count(svg, "<circle"));  // two and the legend's
      EXPECT_EQ(std::string::npos, svg.find("nan"));
      EXPECT_EQ(std::string::npos, svg.find("inf"));
    }
  }
  const std::string zero = SvgLinePlot({"t", {"x"}, {"y"}, {{"a", {0}, {0}}}});
  EXPECT_EQ(std::string::npos, zero.find("nan"));
}

TEST(SvgLinePlot, LeavesOutWhatItCannotShowAndSaysSo) {
  const LinePlot plot{
      "t",
      {"x", false},
      {"y", true},
      {{"a", {0, 1, 2, 3, 4, 5, 6}, {1, 2, kNan, 3, -1, kInfinity, 5}}}};
  const std::string svg = SvgLinePlot(plot);
  EXPECT_EQ("", MarkupError(svg));
  EXPECT_EQ(std::string::npos, svg.find("nan"));
  EXPECT_EQ(std::string::npos, svg.find("inf"));
  EXPECT_EQ(size_t{5}, Count(svg, "<circle"));
  EXPECT_NE(std::string::npos, svg.find("3 values cannot be shown"));
  // The line is broken twice: it has three parts.
  const size_t path = svg.find("<path d=\"M");
  ASSERT_NE(std::string::npos, path);
  const std::string d = svg.substr(path, svg.find(" fill", path) - path);
  EXPECT_EQ(size_t{3}, Count(d, "M"));
  EXPECT_EQ(size_t{1}, Count(d, "L"));
}

}  // namespace
}  // namespace ibrdf
