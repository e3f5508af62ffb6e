#include "ibrdf/solvers/report/report_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ibrdf/io/png.h"
#include "ibrdf/solvers/report/report_plots.h"
#include "ibrdf/solvers/report/report_warnings.h"
#include "tests/support/base64.h"
#include "tests/support/markup.h"

namespace ibrdf {
namespace {
using Json = nlohmann::ordered_json;

Json Entry(const char* stage, double seconds, double scale, int pixels,
           double cost) {
  return {{"stage", stage},
          {"seconds", seconds},
          {"scale", scale},
          {"pixels", pixels},
          {"cost", cost},
          {"likelihood", cost},
          {"reflectance_prior", 0.0},
          {"illumination_prior", 2.0},
          {"misfit", 0.1}};
}

// A document as result.json of a joint problem with truth.
Json JointResult() {
  return {
      {"ibrdf_version", "0.1.0"},
      {"status", "ok"},
      {"problem",
       {{"image", {{"file", "a <b> & \"c\".exr"}}},
        {"geometry", {{"sphere", Json::object()}}},
        {"problem", "joint"},
        {"effects", "auto"},
        {"solver", {{"seconds", 60.0}}}}},
      {"effects", "none: the sphere is convex"},
      {"gauge", "least prior cost"},
      {"start", "gold & silver"},
      {"posterior",
       {{"lobes",
         {{{"code_std", {0.1, 0.2}}, {"log_colour_std", {0.05, 0.2, 1.1}}}}},
        {"brdf_spread", 0.21875},
        {"brdf_log_rmse_expected", 0.34375},
        {"brdf_log_rmse_90", 0.6875},
        {"alternatives",
         {{{"start", "gold & silver"},
           {"cost_above_best", 0.0},
           {"brdf_log_difference", 0.02}},
          {{"start", "<chrome>"},
           {"cost_above_best", 4.0},
           {"brdf_log_difference", 0.5}}}}}},
      {"seed", 1},
      {"pixels_used", 100},
      {"pixels_of_object", 100},
      {"likelihood", {{"scale", 0.02}, {"epsilon", 1e-6}}},
      {"metrics",
       {{"seconds", 20.0},
        {"misfit", 0.02},
        {"brdf_log_rmse", 1.25},
        {"brdf_log_rmse_aligned", 0.375},
        {"illumination_relative_log_rmse", 0.3125},
        {"image_log_rmse", 0.04}}},
      {"trace",
       {Entry("rank 9 materials", 1, 0, 100, -50),
        Entry("coarse map round 1", 2, 0.1, 25, 300),
        Entry("map round 1", 3, 0.05, 100, 500),
        Entry("end", 4, 0.05, 100, 400)}}};
}

Json Lobes() {
  return {{"formula", "colour * density"},
          {"lobes",
           {{{"code", {0.3, 0.4}}, {"colour_raw_merl", {10.0, 20.0, 30.0}}}}}};
}

ReportGroup Pictures() {
  ReportFigure figure;
  figure.caption = "Input \"x\" <raw>";
  figure.pixels = Rgb8Image(4, 2);
  for (size_t i = 0; i < figure.pixels.rgb.size(); ++i) {
    figure.pixels.rgb[i] = static_cast<uint8_t>(11 * i);
  }
  figure.bar = ReportFigure::Bar::kSigned;
  figure.range = 0.5;
  figure.map = true;
  return {"Image & map", "what to look for", {figure}};
}

std::string Page(const ReportInput& input) {
  const StatusOr<std::string> page = ReportPage(input);
  EXPECT_TRUE(page.ok()) << page.status().message();
  return page.ok() ? *page : "";
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ReportPage, ShowsWhatTheResultHolds) {
  const std::string page =
      Page({"red & <plastic>.yaml", JointResult(), Lobes(), {Pictures()}});
  EXPECT_EQ("", MarkupError(page));
  for (const char* part :
       {"<h1>red &amp; &lt;plastic&gt;.yaml</h1>",
        "a &lt;b&gt; &amp; &quot;c&quot;.exr", "Image &amp; map",
        "Input &quot;x&quot; &lt;raw&gt;", "least prior cost", "&lt;chrome&gt;",
        "0.01832",  // exp(-4)
        "1.25", "0.375", "0.3125", "solver.seconds",
        "within a factor of 3.004",  // exp(1.1)
        "0.2188", "0.3438 at such a spread (a factor of 1.41", "0.6875",
        "the sphere is convex", "time (s)", "</svg>"}) {
    EXPECT_TRUE(Contains(page, part)) << part;
  }
  EXPECT_FALSE(Contains(page, "<script"));
  EXPECT_FALSE(Contains(page, "<plastic>"));
  EXPECT_FALSE(Contains(page, "No truth was given"));
  // Nothing is loaded from elsewhere.
  EXPECT_FALSE(Contains(page, "href="));
  EXPECT_FALSE(Contains(page, "url("));
}

TEST(ReportPage, PicturesAreTheFilesOfTheirPixels) {
  const ReportGroup group = Pictures();
  const std::string page = Page({"p", JointResult(), nullptr, {group}});
  const std::string prefix = "src=\"data:image/png;base64,";
  const size_t begin = page.find(prefix);
  ASSERT_NE(std::string::npos, begin);
  const size_t at = begin + prefix.size();
  EXPECT_EQ(*EncodePng(group.figures[0].pixels),
            DecodeBase64(page.substr(at, page.find('"', at) - at)));
}

TEST(ReportPage, WithoutTruthItSaysSo) {
  Json result = JointResult();
  result["metrics"] = {{"seconds", 1.0}, {"misfit", 0.02}};
  const std::string page = Page({"p", result, Lobes(), {}});
  EXPECT_EQ("", MarkupError(page));
  EXPECT_TRUE(Contains(page, "No truth was given"));
  EXPECT_FALSE(Contains(page, "Against the truth"));
}

TEST(ReportPage, KnownReflectanceHasNoPosteriorAndNoGauge) {
  Json result = JointResult();
  result["problem"]["problem"] = "illumination";
  result["posterior"] = {{"alternatives", Json::array()}};
  const std::string page = Page({"p", result, nullptr, {}});
  EXPECT_EQ("", MarkupError(page));
  EXPECT_FALSE(Contains(page, "How well the reflectance is known"));
  EXPECT_FALSE(Contains(page, "(s R, L / s)"));
}

TEST(ReportPage, EmptyAndShortTraces) {
  Json result = JointResult();
  result["trace"] = Json::array();
  EXPECT_FALSE(Contains(Page({"p", result, Lobes(), {}}), "<svg"));
  result["trace"] = {Entry("end", 4, 0.05, 100, 400)};
  const std::string page = Page({"p", result, Lobes(), {}});
  EXPECT_EQ("", MarkupError(page));
  EXPECT_TRUE(Contains(page, "<svg"));
}

// Null and NaN everywhere: of numbers, lists and whole parts.
TEST(ReportPage, MissingValuesAreShownAsSuch) {
  Json result = JointResult();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  result["metrics"]["misfit"] = nullptr;
  result["metrics"]["brdf_log_rmse"] = nan;
  result["posterior"]["lobes"][0]["log_colour_std"] = {nan, nullptr, 0.1};
  result["posterior"]["lobes"][0]["code_std"] = nullptr;
  result["posterior"]["alternatives"][1]["cost_above_best"] = nullptr;
  for (Json& entry : result["trace"]) entry["misfit"] = nan;
  result["trace"][2]["cost"] = nullptr;
  const std::string page = Page({"p", result, Lobes(), {}});
  EXPECT_EQ("", MarkupError(page));
  EXPECT_TRUE(Contains(page, "The misfit is not a number."));
  EXPECT_FALSE(Contains(page, "nan"));
  EXPECT_FALSE(Contains(page, "null"));
  const Json whole = JointResult();
  for (const auto& [key, value] : whole.items()) {
    Json without = whole;
    without.erase(key);
    EXPECT_EQ("", MarkupError(Page({"p", without, Lobes(), {}}))) << key;
    without[key] = nullptr;
    EXPECT_EQ("", MarkupError(Page({"p", without, Lobes(), {}}))) << key;
  }
  EXPECT_EQ("", MarkupError(Page({"", nullptr, nullptr, {}})));
}

TEST(TracePlots, SeriesHoldWhatCompares) {
  const std::vector<LinePlot> plots = TracePlots(JointResult()["trace"]);
  ASSERT_EQ(size_t{3}, plots.size());
  ASSERT_EQ(size_t{3}, plots[0].series.size());  // search, 25 and 100 pixels
  EXPECT_EQ(std::vector<double>({3, 4}), plots[0].series[2].x);
  ASSERT_EQ(size_t{1}, plots[1].series.size());
  EXPECT_EQ(std::vector<double>({-50}), plots[1].series[0].y);
  // Sum, likelihood and the light's prior; no prior of a reflectance that is
  // zero throughout.
  ASSERT_EQ(size_t{3}, plots[2].series.size());
  ASSERT_EQ(size_t{4}, plots[2].series[0].x.size());
  EXPECT_EQ(2.0, plots[2].series[0].x[0]);
  EXPECT_TRUE(std::isnan(plots[2].series[0].x[1]));  // 25 pixels, then 100
  EXPECT_EQ(4.0, plots[2].series[0].x[3]);
  EXPECT_FALSE(Contains(SvgLinePlot(plots[2]), "cannot be shown"));
  for (const LinePlot& plot : plots) {
    EXPECT_EQ("time (s)", plot.x.label);
    EXPECT_TRUE(Contains(plot.y.label, "("));  // a unit
  }
  EXPECT_TRUE(TracePlots(nullptr).empty());
}

TEST(ResultWarnings, AreSilentWithoutCause) {
  EXPECT_TRUE(ResultWarnings(JointResult()).empty());
}

TEST(ResultWarnings, NameEachCause) {
  const auto warned = [](const char* pointer, const Json& value,
                         const std::string& word) {
    Json result = JointResult();
    result[Json::json_pointer(pointer)] = value;
    const std::vector<std::string> warnings = ResultWarnings(result);
    ASSERT_EQ(size_t{1}, warnings.size()) << pointer;
    EXPECT_TRUE(Contains(warnings[0], word)) << warnings[0];
  };
  warned("/status", "no_improvement", "start");
  warned("/status", "interrupted", "stopped");
  warned("/metrics/misfit", 0.5, "does not explain");
  warned("/metrics/seconds", 55.0, "time limit");
  warned("/pixels_used", 90, "10 of the object's 100");
  warned("/posterior/alternatives/1/cost_above_best", 1.0, "<chrome>");
  warned("/posterior/brdf_log_rmse_expected", 0.9, "a factor of 2.46");
  warned("/problem/geometry", {{"mesh", "a.obj"}}, "convex");
}

}  // namespace
}  // namespace ibrdf
