#include "ibrdf/solvers/report/report_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/report/posterior_plots.h"
#include "ibrdf/solvers/report/report_plots.h"
#include "ibrdf/solvers/report/report_warnings.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"
#include "tests/report/contains.h"
#include "tests/support/base64.h"
#include "tests/support/markup.h"
#include "tests/support/non_finite.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

constexpr double kSpread = 0.21875;

TraceEntry Entry(const char* stage, double seconds, double scale, int pixels,
                 double cost) {
  TraceEntry entry;
  entry.stage = stage;
  entry.seconds = seconds;
  entry.scale = scale;
  entry.pixels = pixels;
  entry.cost = entry.likelihood = cost;
  entry.illumination_prior = 2.0;
  entry.misfit = 0.1;
  return entry;
}

std::vector<TraceEntry> Trace() {
  return {Entry("rank 9 materials", 1, 0, 100, -50),
          Entry("coarse map round 1", 2, 0.1, 25, 300),
          Entry("map round 1", 3, 0.05, 100, 500),
          Entry("end", 4, 0.05, 100, 400)};
}

// One lobe with the deviations 0.1, ..., 0.4 of its code and 0.05, 0.2 and 1.1
// of its log colours.
Solution OneLobe() {
  Solution solution;
  solution.brdf.raw = {1.0};
  solution.lobe_parameters = {0.3,          0.4,          0.0,         0.0,
                              std::log(10), std::log(20), std::log(30)};
  const double deviations[] = {0.1, 0.2, 0.3, 0.4, 0.05, 0.2, 1.1};
  solution.lobe_covariance.assign(49, 0.0);
  for (size_t i = 0; i < 7; ++i) {
    solution.lobe_covariance[8 * i] = deviations[i] * deviations[i];
  }
  solution.spread = kSpread;
  solution.alternatives = {{"gold & silver", 0.0, 0.02},
                           {"<chrome>", 4.0, 0.5}};
  solution.scale = 0.02;
  solution.epsilon = 1e-6;
  solution.start = "gold & silver";
  solution.pixels_used = 100;
  solution.trace = Trace();
  return solution;
}

// A solved joint problem with truth, to be changed.
struct Example {
  Example() {
    problem.path = "folder/red & <plastic>.yaml";
    problem.image.file = "a <b> & \"c\".exr";
    problem.solver.seconds = 60.0;
    inverse.model = std::make_shared<const NeuralBrdfModel>(TinyModel(1));
    inverse.lobes = 1;
    inverse.points.resize(100);
    inverse.solver.estimator = SolverEstimator::kMaximum;
    solution = OneLobe();
    metrics.seconds = 20.0;
    metrics.misfit = 0.02;
    metrics.brdf.emplace();
    metrics.brdf->log_rmse = 1.25;
    metrics.brdf->log_rmse_aligned = 0.375;
    metrics.illumination.emplace();
    metrics.illumination->relative_log_rmse = 0.3125;
    metrics.image.emplace();
    metrics.image->log_rmse = 0.04;
  }
  SolvedProblem Solved() const {
    return {problem, inverse, truth, solution, metrics};
  }

  Problem problem;
  InverseProblem inverse;
  Truth truth;
  Solution solution;
  ResultMetrics metrics;
};

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

std::string Page(const Example& example,
                 const std::vector<ReportGroup>& groups = {}) {
  const StatusOr<std::string> page = ReportPage(example.Solved(), groups);
  EXPECT_TRUE(page.ok()) << page.status().message();
  return page.ok() ? *page : "";
}

TEST(ReportPage, ShowsWhatTheResultHolds) {
  const std::string page = Page(Example(), {Pictures()});
  EXPECT_EQ("", MarkupError(page));
  const ErrorToExpect error = ExpectError(kSpread);
  for (const std::string& part : std::vector<std::string>{
           "<h1>a &lt;b&gt; &amp; &quot;c&quot;.exr</h1>", "Image &amp; map",
           "Input &quot;x&quot; &lt;raw&gt;", "least prior cost",
           "&lt;chrome&gt;",
           "0.018",  // exp(-4)
           "1.25", "0.375", "0.3125", "solver.seconds",
           "30, within a factor of 3",  // exp(1.1)
           "by 0.22 in the logarithm",
           Format("%.2g at such a spread (a factor of 1.5", error.median),
           Format("%.2g", error.most), "<section class=\"verdict\">",
           "Trust, with care, the light&#39;s directions, the object&#39;s hue "
           "and the object&#39;s gloss",
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
  const std::string page = Page(Example(), {group});
  const std::string prefix = "src=\"data:image/png;base64,";
  const size_t begin = page.find(prefix);
  ASSERT_NE(std::string::npos, begin);
  const size_t at = begin + prefix.size();
  EXPECT_EQ(*EncodePng(group.figures[0].pixels),
            DecodeBase64(page.substr(at, page.find('"', at) - at)));
}

TEST(ReportPage, WithoutTruthItSaysSo) {
  Example example;
  example.metrics.brdf.reset();
  example.metrics.illumination.reset();
  const std::string page = Page(example);
  EXPECT_EQ("", MarkupError(page));
  EXPECT_TRUE(Contains(page, "No truth was given"));
  EXPECT_FALSE(Contains(page, "Against the truth"));
}

TEST(ReportPage, KnownReflectanceHasNoPosteriorAndNoGauge) {
  Example example;
  example.problem.kind = ProblemKind::kIllumination;
  example.solution.brdf.raw.clear();
  example.solution.alternatives.clear();
  const std::string page = Page(example);
  EXPECT_EQ("", MarkupError(page));
  EXPECT_FALSE(Contains(page, "How well the reflectance is known"));
  EXPECT_FALSE(Contains(page, "(s R, L / s)"));
}

TEST(ReportPage, ShowsWhatThePosteriorLeavesOpen) {
  Example example;
  BrdfSlice slice;
  slice.name = "theta_d = 0";
  slice.angle = "theta_h (degrees)";
  slice.degrees = {0, 45, 90};
  for (int c = 0; c < 3; ++c) {
    slice.value[c] = {3, 2, 1};
    slice.low[c] = {2, 1, 0.5};
    slice.high[c] = {4, 3, 2};
  }
  example.solution.slices = {slice};
  example.solution.map_variance_left = Image(4, 2);
  example.solution.map_variance_left_by_degree = {0.1, 0.6};
  const std::string page = Page(example);
  EXPECT_EQ("", MarkupError(page));
  EXPECT_TRUE(Contains(page, "Slices of the BRDF"));
  EXPECT_TRUE(Contains(page, "fill-opacity=\"0.18\""));
  EXPECT_TRUE(Contains(page, "over 100 % of the sphere"));
  EXPECT_TRUE(Contains(page, "degree l of spherical harmonics"));
  EXPECT_FALSE(Contains(Page(Example()), "Slices of the BRDF"));
  EXPECT_FALSE(Contains(Page(Example()), "How well the light is known"));
}

TEST(PosteriorPlots, HoldWhatIsDetermined) {
  const LinePlot plot = DegreePlot({0.25, 1.0});
  EXPECT_EQ(std::vector<double>({0.75, 0.0}), plot.series[0].y);
  EXPECT_EQ(std::vector<double>({0.0, 1.0}), plot.series[0].x);
}

// The level is known, and what is not explained counts.
TEST(ReportPage, UnderAKnownLightItSaysWhatWasSearchedAndExpected) {
  Example example;
  example.problem.kind = ProblemKind::kReflectance;
  example.inverse.kind = ProblemKind::kReflectance;
  example.inverse.known_map = Image(2, 1);
  example.solution.spread = 0.1;
  example.solution.structured_misfit = 0.01;
  example.solution.models = {{"default", nullptr}};
  example.solution.model_weights = {1.0};
  example.solution.alternatives.clear();
  const std::string one = Page(example);
  EXPECT_FALSE(Contains(one, "No other candidates"));
  EXPECT_TRUE(Contains(one, "The model default alone was searched."));
  EXPECT_TRUE(Contains(one, "the median of samples"));
  const double expected = std::hypot(0.055, 0.12);
  EXPECT_NEAR(expected, ExpectError(example.solution, false).median, 1e-9);
  EXPECT_TRUE(Contains(one, "half were off by more than 0.13"));
  example.solution.models.push_back({"broad", nullptr});
  example.solution.model_weights = {0.75, 0.25};
  const std::string two = Page(example);
  EXPECT_TRUE(Contains(two, "mean of the models&#39; optima") ||
              Contains(two, "mean of the models' optima"));
  EXPECT_TRUE(Contains(two, "the model broad has 25 %"));
}

TEST(ReportPage, EmptyAndShortTraces) {
  Example example;
  example.solution.trace.clear();
  EXPECT_FALSE(Contains(Page(example), "<svg"));
  example.solution.trace = {Entry("end", 4, 0.05, 100, 400)};
  const std::string page = Page(example);
  EXPECT_EQ("", MarkupError(page));
  EXPECT_TRUE(Contains(page, "<svg"));
}

TEST(ReportPage, NumbersThatAreNotFiniteAreShownAsSuch) {
  Example example;
  example.metrics.misfit = kNan;
  example.metrics.brdf->log_rmse = kNan;
  std::vector<double>& covariance = example.solution.lobe_covariance;
  covariance[0] = covariance[8 * 4] = kNan;  // of the code, of a log colour
  covariance[8 * 5] = -1.0;
  example.solution.alternatives[1].cost = kNan;
  for (TraceEntry& entry : example.solution.trace) entry.misfit = kNan;
  example.solution.trace[2].cost = kNan;
  const std::string page = Page(example);
  EXPECT_EQ("", MarkupError(page));
  EXPECT_TRUE(Contains(page, "The misfit is not a number."));
  EXPECT_FALSE(Contains(page, "nan"));
  EXPECT_FALSE(Contains(page, "null"));
}

TEST(ReportPage, AnyPartMayBeMissing) {
  const std::vector<std::function<void(Example*)>> removals = {
      [](Example* e) { e->problem = {}; },
      [](Example* e) { e->problem.path.clear(); },
      [](Example* e) { e->inverse.effects = {}; },
      [](Example* e) { e->inverse.points.clear(); },
      [](Example* e) { e->solution = {}; },
      [](Example* e) { e->solution.start.clear(); },
      [](Example* e) { e->solution.lobe_covariance.clear(); },
      [](Example* e) { e->solution.lobe_parameters.clear(); },
      [](Example* e) { e->solution.spread = kNan; },
      [](Example* e) { e->solution.alternatives.clear(); },
      [](Example* e) { e->solution.trace.clear(); },
      [](Example* e) { e->solution.scale = e->solution.epsilon = kNan; },
      [](Example* e) { e->metrics = {}; },
      [](Example* e) { e->metrics.brdf.reset(); },
      [](Example* e) { e->metrics.illumination.reset(); },
      [](Example* e) { e->metrics.image.reset(); }};
  Example nothing;
  for (size_t i = 0; i < removals.size(); ++i) {
    Example example;
    removals[i](&example);
    removals[i](&nothing);
    EXPECT_EQ("", MarkupError(Page(example))) << i;
  }
  EXPECT_EQ("", MarkupError(Page(nothing)));
}

TEST(TracePlots, SeriesHoldWhatCompares) {
  const std::vector<LinePlot> plots = TracePlots(Trace());
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
  EXPECT_TRUE(TracePlots({}).empty());
}

// As a look that saw edges of colour of that strength (ColourSteps).
void LookAtEdges(double colour_steps, Example* example) {
  const auto look = std::make_shared<ObjectLook>();
  look->check.colour_steps = colour_steps;
  example->inverse.look = look;
}

TEST(ResultWarnings, AreSilentWithoutCause) {
  EXPECT_TRUE(ResultWarnings(Example().Solved()).empty());
}

TEST(ResultWarnings, NameEachCause) {
  const auto warned = [](const std::function<void(Example*)>& change,
                         const std::string& word) {
    Example example;
    change(&example);
    const std::vector<std::string> warnings = ResultWarnings(example.Solved());
    ASSERT_EQ(size_t{1}, warnings.size()) << word;
    EXPECT_TRUE(Contains(warnings[0], word)) << warnings[0];
  };
  const auto ended = [](StatusCode code) {
    return [code](Example* e) { e->solution.status = Status(code, "ended"); };
  };
  warned(ended(StatusCode::kNoImprovement), "initial guess");
  warned(ended(StatusCode::kInterrupted), "stopped");
  // Beyond a factor of five no number is given.
  warned([](Example* e) { e->solution.spread = 3.0; }, "does not determine");
  warned(
      [](Example* e) {
        e->inverse.points.resize(1);
        e->solution.pixels_used = 1;
      },
      "tells nothing: it was made from 1 of the object's 1 pixels");
  warned([](Example* e) { e->metrics.misfit = 0.5; }, "does not explain");
  warned([](Example* e) { e->metrics.seconds = 55.0; }, "time limit");
  warned([](Example* e) { e->solution.pixels_used = 90; },
         "10 of the object's 100");
  warned(
      [](Example* e) {
        e->inverse.dark.num_unlit = 10;
        e->solution.pixels_used = 90;
      },
      "10 of the object's 100 pixels took no part: the known light");
  warned(
      [](Example* e) {
        e->inverse.dark.ambient_deviation.setConstant(0.1);
        e->inverse.dark.num_below_floor = 7;
        e->solution.ambient = {0.5, 0.25, 0.125};
      },
      "0.5, 0.25, 0.125 was estimated for all pixels (illumination.ambient). "
      "7 lit pixels");
  warned(
      [](Example* e) {
        e->solution.alternatives[1].cost = 1.0;
        e->solution.alternatives[1].difference_from_best = 0.5;
      },
      "<chrome>");
  warned(
      [](Example* e) {
        e->inverse.variation = ReflectanceVariation::kAuto;
        LookAtEdges(1.5, e);
      },
      "if it is painted, set reflectance.variation: albedo");
  // An expected error of 0.9.
  warned([](Example* e) { e->solution.spread = 0.9 / ExpectError(1.0).median; },
         "a factor of 2.5");
  warned([](Example* e) { e->inverse.warnings = {"a.png: clipped"}; },
         "a.png: clipped");
}

// The estimate may be a mean of optima, which is far from each of them.
TEST(ResultWarnings, TheBestOptimumIsNoRivalOfItself) {
  Example example;
  example.solution.alternatives[0].brdf_log_difference = 2.0;
  EXPECT_TRUE(ResultWarnings(example.Solved()).empty());
}

// Under a known light paint is asked of the image where the look saw no edges.
TEST(ResultWarnings, EdgesAreNamedWhereTheyWereSeenAlone) {
  Example example;
  example.inverse.variation = ReflectanceVariation::kAuto;
  EXPECT_TRUE(ResultWarnings(example.Solved()).empty());
  LookAtEdges(0.5, &example);
  EXPECT_TRUE(ResultWarnings(example.Solved()).empty());
  // Paint was found all the same.
  example.solution.albedo = Image(1, 1);
  const std::vector<std::string> warnings = ResultWarnings(example.Solved());
  ASSERT_EQ(1u, warnings.size());
  EXPECT_TRUE(Contains(warnings[0], "One material does not explain the image"))
      << warnings[0];
  LookAtEdges(1.5, &example);
  EXPECT_TRUE(Contains(ResultWarnings(example.Solved())[0], "has sharp edges"));
}

TEST(ResultWarnings, GlossCanHideAnotherCurve) {
  Example example;
  CurveEstimate aces, power;
  aces.curve = {ResponseKind::kAces, 0.5, {}};
  aces.log_parameter_std = 0.1;
  power.curve = {ResponseKind::kPower, 2.2, {}};
  power.cost = 1.0;
  example.solution.curves = {aces, power};
  const std::string told =
      "The response curve was estimated: aces, gamma 0.5 (known to some 10 % "
      "at best).";
  const std::string rival =
      " The image's codes do not tell it from power, p 2.2.";
  EXPECT_EQ(
      std::vector<std::string>{
          told +
          " Another gloss may explain the image by another curve: if the "
          "curve is known, say so (image.response)." +
          rival},
      ResultWarnings(example.Solved()));
  example.problem.kind = ProblemKind::kIllumination;
  EXPECT_EQ(std::vector<std::string>{told + rival},
            ResultWarnings(example.Solved()));
}

TEST(ResultWarnings, EffectsAreANoteOfTheReportAlone) {
  Example example;
  EXPECT_EQ("", EffectsNote(example.Solved()));
  example.problem.geometry.kind = GeometryKind::kMesh;
  EXPECT_TRUE(Contains(EffectsNote(example.Solved()), "convex"));
  EXPECT_TRUE(ResultWarnings(example.Solved()).empty());
  const StatusOr<std::string> page = ReportPage(example.Solved(), {});
  ASSERT_TRUE(page.ok());
  EXPECT_TRUE(Contains(*page, "convex"));
}

}  // namespace
}  // namespace ibrdf
