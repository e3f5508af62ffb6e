#include "ibrdf/solvers/solve/solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/render/reference_renderer.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kSize = 12;  // pixels a side
constexpr double kSunMisfit = 0.01;

// A sphere of the model's first material under a smooth map; a budget of time
// that no test needs, so that iterations alone end it.
class InverseRenderingTest : public ::testing::TestWithParam<ProblemKind> {
 protected:
  InverseRenderingTest() {
    problem_.illumination_prior = IlluminationPrior::kNone;
    problem_.solver.max_iterations = 2;
    SetKind(ProblemKind::kJoint);
    // Not a code of the embedding, so that there is something to find.
    parameters_ = {0.3,  -0.4, 0.2, 0.1,  5.0, 4.6, 4.2,
                   -0.5, 0.1,  0.3, -0.2, 3.0, 3.5, 3.3};
    const FlowLobes lobes(*problem_.model, 2, problem_.transport.grid, 1);
    truth_ = lobes.Grid(parameters_.data());
    const Transport transport(problem_.points, 8, 16, problem_.transport);
    std::vector<double> L_o(3 * problem_.points.size());
    transport.Render(truth_, map_.rgb.data(), L_o.data());
    for (size_t i = 0; i < L_o.size(); ++i) {
      problem_.image.rgb[3 * problem_.points[i / 3].pixel + i % 3] =
          static_cast<float>(L_o[i] * std::exp(0.02 * std::sin(11.0 * i)));
    }
  }

  void SetKind(ProblemKind kind) {
    problem_.kind = kind;
    problem_.known_map.reset();
    problem_.known_brdf.reset();
    if (kind == ProblemKind::kReflectance) problem_.known_map = map_;
    if (kind == ProblemKind::kIllumination) problem_.known_brdf = truth_;
  }
  Solution Solve(const std::atomic<bool>* stop = nullptr) const {
    const StatusOr<Solution> e = SolveInverseRendering(problem_, nullptr, stop);
    EXPECT_TRUE(e.ok()) << e.status().message();
    return *e;
  }
  // All parts are there and finite.
  void ExpectWhole(const Solution& e) const {
    const bool lobes = problem_.kind != ProblemKind::kIllumination;
    EXPECT_EQ(lobes ? size_t{14} : size_t{0}, e.lobe_parameters.size());
    EXPECT_EQ(lobes ? size_t{3} * kMerlBins : size_t{0}, e.brdf.raw.size());
    ASSERT_EQ(16, e.map.width);
    ASSERT_EQ(8, e.map.height);
    ASSERT_EQ(size_t{3 * 128}, e.map.rgb.size());
    ASSERT_EQ(problem_.image.rgb.size(), e.render.rgb.size());
    for (const double v : e.lobe_parameters) EXPECT_TRUE(std::isfinite(v));
    for (const double v : e.brdf.raw) ASSERT_TRUE(std::isfinite(v));
    for (const float v : e.map.rgb) EXPECT_TRUE(std::isfinite(v) && v >= 0.0f);
    for (const float v : e.render.rgb) EXPECT_TRUE(std::isfinite(v));
    EXPECT_TRUE(std::isfinite(e.misfit));
    EXPECT_GT(e.scale, 0.0);
    EXPECT_GT(e.epsilon, 0.0);
    ASSERT_FALSE(e.trace.empty());
    for (const TraceEntry& t : e.trace) {
      EXPECT_TRUE(std::isfinite(t.cost)) << t.stage;
      EXPECT_NEAR(t.cost,
                  t.likelihood + t.reflectance_prior + t.illumination_prior,
                  1e-9 * std::abs(t.cost));
    }
  }

  InverseProblem problem_ = BallProblem(kSize);
  const Image map_ = SmoothMap(8, 16);
  std::vector<double> parameters_;
  BrdfGrid truth_;
};

TEST_P(InverseRenderingTest, ImprovesOnItsStartAndRendersItsEstimate) {
  SetKind(GetParam());
  problem_.solver.max_iterations = 12;
  const Solution e = Solve();
  ExpectWhole(e);
  EXPECT_EQ(StatusCode::kOk, e.status.code()) << e.status.message();
  EXPECT_EQ(static_cast<int64_t>(problem_.points.size()), e.pixels_used);
  // The misfit of the start is of order 1; the wobble on the image is 0.013.
  // With both unknown, the priors of the few texels and codes hold the maximum
  // of the posterior away from these few pixels.
  EXPECT_LT(e.misfit, 0.5 * e.trace.front().misfit);
  if (GetParam() != ProblemKind::kJoint) {
    EXPECT_LT(e.misfit, 0.1);
  }
  EXPECT_EQ(e.misfit, e.trace.back().misfit);
  double sum = 0.0;
  for (size_t i = 0; i < 3 * problem_.points.size(); ++i) {
    const size_t at = 3 * problem_.points[i / 3].pixel + i % 3;
    ASSERT_GT(e.render.rgb[at], 0.0f);
    sum += std::abs(std::log(e.render.rgb[at] + e.epsilon) -
                    std::log(problem_.image.rgb[at] + e.epsilon));
  }
  // The render is stored as float.
  EXPECT_NEAR(sum / (3.0 * problem_.points.size()), e.misfit, 1e-6);
  if (GetParam() == ProblemKind::kReflectance) {
    EXPECT_EQ(map_.rgb, e.map.rgb);
  }
}

TEST_P(InverseRenderingTest, ThreadsDoNotChangeBits) {
  SetKind(GetParam());
  const Solution one = Solve();
  problem_.num_threads = 2;
  problem_.transport.num_threads = 2;
  const Solution two = Solve();
  EXPECT_EQ(one.lobe_parameters, two.lobe_parameters);
  EXPECT_EQ(one.map.rgb, two.map.rgb);
  EXPECT_EQ(one.render.rgb, two.render.rgb);
  EXPECT_EQ(one.brdf.raw, two.brdf.raw);
  EXPECT_EQ(one.misfit, two.misfit);
}

TEST_P(InverseRenderingTest, UnitsOfRadianceScaleRadianceAlone) {
  SetKind(GetParam());
  problem_.epsilon = 1e-4;
  const Solution one = Solve();
  const Image image = problem_.image;
  for (const int exponent : {-100, -3, 100}) {
    const auto scaled = [exponent](std::vector<float> rgb) {
      for (float& v : rgb) v = std::ldexp(v, exponent);
      return rgb;
    };
    problem_.image.rgb = scaled(image.rgb);
    problem_.epsilon = std::ldexp(1e-4, exponent);
    if (problem_.known_map) problem_.known_map->rgb = scaled(map_.rgb);
    const Solution other = Solve();
    EXPECT_EQ(one.lobe_parameters, other.lobe_parameters) << exponent;
    EXPECT_EQ(one.brdf.raw, other.brdf.raw) << exponent;
    EXPECT_EQ(scaled(one.map.rgb), other.map.rgb) << exponent;
    EXPECT_EQ(scaled(one.render.rgb), other.render.rgb) << exponent;
    EXPECT_EQ(std::ldexp(one.epsilon, exponent), other.epsilon);
    EXPECT_EQ(one.misfit, other.misfit) << exponent;
    EXPECT_EQ(one.end_cost, other.end_cost) << exponent;
  }
}

TEST_P(InverseRenderingTest, RadianceAtTheEndsOfFloatStaysFinite) {
  SetKind(GetParam());
  const Image image = problem_.image;
  for (const double factor : {1e-37, 1e36}) {
    for (size_t i = 0; i < image.rgb.size(); ++i) {
      problem_.image.rgb[i] = static_cast<float>(image.rgb[i] * factor);
    }
    ExpectWhole(Solve());
  }
}

TEST_P(InverseRenderingTest, StopFlagLeavesAWholeEstimate) {
  SetKind(GetParam());
  const std::atomic<bool> stop{true};
  const Solution e = Solve(&stop);
  EXPECT_EQ(StatusCode::kInterrupted, e.status.code());
  ExpectWhole(e);
}

TEST_P(InverseRenderingTest, StopFromProgressEndsEarly) {
  SetKind(GetParam());
  std::atomic<bool> stop{false};
  problem_.solver.max_iterations = 1000;
  int reports = 0;
  const StatusOr<Solution> e = SolveInverseRendering(
      problem_,
      [&](const TraceEntry&, double share) {
        EXPECT_TRUE(share >= 0.0 && share <= 1.0);
        if (++reports == 2) stop = true;
      },
      &stop);
  ASSERT_TRUE(e.ok());
  EXPECT_EQ(StatusCode::kInterrupted, e->status.code());
  ExpectWhole(*e);
}

TEST_P(InverseRenderingTest, NoIterationsKeepTheStart) {
  SetKind(GetParam());
  problem_.solver.max_iterations = 0;
  const Solution e = Solve();
  ExpectWhole(e);
  EXPECT_EQ(StatusCode::kNoImprovement, e.status.code());
  // What was found of another end says nothing of the start.
  EXPECT_TRUE(e.map_std.rgb.empty());
  EXPECT_TRUE(e.lobe_covariance.empty());
  EXPECT_TRUE(e.alternatives.empty());
}

// More pixels than are transported at once.
TEST_P(InverseRenderingTest, EveryPixelOfALargeImageIsRendered) {
  SetKind(GetParam());
  problem_.solver.max_iterations = 0;
  problem_.solver.gauge = SolverGauge::kPrior;  // others round anew
  const int size = 90;
  problem_.points = SpherePoints(size);
  ASSERT_GT(problem_.points.size(), 5000u);
  problem_.image = Image(size, size);
  std::fill(problem_.image.rgb.begin(), problem_.image.rgb.end(), 1.0f);
  const Solution e = Solve();
  ASSERT_EQ(problem_.image.rgb.size(), e.render.rgb.size());
  const FlowLobes lobes(*problem_.model, 2, problem_.transport.grid, 1);
  const BrdfGrid grid =
      e.lobe_parameters.empty() ? truth_ : lobes.Grid(e.lobe_parameters.data());
  std::vector<double> L_o(3 * problem_.points.size());
  Transport(problem_.points, 8, 16, problem_.transport)
      .Render(grid, e.map.rgb.data(), L_o.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    const size_t at = 3 * problem_.points[i / 3].pixel + i % 3;
    EXPECT_EQ(static_cast<float>(L_o[i]), e.render.rgb[at]) << i;
  }
}

TEST_P(InverseRenderingTest, ImageWithoutAValueIsRefused) {
  SetKind(GetParam());
  for (const float value :
       {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(),
        std::numeric_limits<float>::infinity()}) {
    std::fill(problem_.image.rgb.begin(), problem_.image.rgb.end(), value);
    const Status s = SolveInverseRendering(problem_, nullptr, nullptr).status();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code()) << value;
    EXPECT_NE(std::string::npos, s.message().find("image"));
  }
}

TEST_P(InverseRenderingTest, OnePixelAndWildPixelsGiveFiniteEstimates) {
  SetKind(GetParam());
  problem_.image.At(6, 6)[0] = 1e9f;
  problem_.image.At(5, 6)[1] = std::numeric_limits<float>::quiet_NaN();
  problem_.image.At(4, 6)[2] = -3.0f;
  problem_.image.At(7, 6)[2] = 1e-9f;
  Solution e = Solve();
  ExpectWhole(e);
  EXPECT_EQ(static_cast<int64_t>(problem_.points.size()) - 2, e.pixels_used);
  problem_.points = {problem_.points[problem_.points.size() / 2]};
  ExpectWhole(Solve());
}

// Pixels that the known light does not reach, whatever they hold, and an
// ambient term that all others have.
TEST_F(InverseRenderingTest, KnownLightWithDarkPixels) {
  SetKind(ProblemKind::kReflectance);
  problem_.solver.max_iterations = 12;
  const Image clean = problem_.image;
  const double level = clean.At(6, 6)[1];
  const Eigen::Array3d ambient = level * Eigen::Array3d(0.5, 0.2, 0.1);
  problem_.dark.unlit.assign(problem_.image.num_pixels(), 0);
  for (size_t i = 0; i < problem_.points.size(); ++i) {
    float* rgb = &problem_.image.rgb[3 * problem_.points[i].pixel];
    const bool unlit = i % 4 == 0;
    problem_.dark.unlit[problem_.points[i].pixel] = unlit ? 1 : 0;
    for (int c = 0; c < 3; ++c) {
      rgb[c] = unlit ? 1e6f : static_cast<float>(rgb[c] + ambient[c]);
    }
  }
  problem_.dark.ambient = 1.1 * ambient;
  problem_.dark.ambient_deviation = 0.2 * ambient;
  const Solution e = Solve();
  ExpectWhole(e);
  const size_t unlit = (problem_.points.size() + 3) / 4;
  EXPECT_EQ(static_cast<int64_t>(problem_.points.size() - unlit),
            e.pixels_used);
  EXPECT_LT(e.misfit, 0.1);
  for (int c = 0; c < 3; ++c) {
    EXPECT_GE(e.ambient[c], 0.0);
    EXPECT_NEAR(ambient[c], e.ambient[c], 0.5 * ambient[c]) << c;
  }
  // The render has the ambient term; a unit of radiance changes nothing.
  for (size_t i = 0; i < problem_.points.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      ASSERT_GT(e.render.rgb[3 * problem_.points[i].pixel + c],
                0.999f * static_cast<float>(e.ambient[c]));
    }
  }
  for (float& v : problem_.image.rgb) v *= 1024.0f;
  for (float& v : problem_.known_map->rgb) v *= 1024.0f;
  problem_.dark.ambient *= 1024.0;
  problem_.dark.ambient_deviation *= 1024.0;
  const Solution brighter = Solve();
  EXPECT_EQ(e.lobe_parameters, brighter.lobe_parameters);
  EXPECT_TRUE((brighter.ambient == 1024.0 * e.ambient).all());
}

INSTANTIATE_TEST_SUITE_P(Problems, InverseRenderingTest,
                         ::testing::Values(ProblemKind::kJoint,
                                           ProblemKind::kReflectance,
                                           ProblemKind::kIllumination),
                         [](const ::testing::TestParamInfo<ProblemKind>& p) {
                           return p.param == ProblemKind::kJoint ? "Joint"
                                  : p.param == ProblemKind::kReflectance
                                      ? "Reflectance"
                                      : "Illumination";
                         });

// The sun is one texel of 64 rows, which the coarse rings here miss or take for
// more. The image is the reference renderer's.
TEST_F(InverseRenderingTest, ASmallSunUnderKnownLightIsRendered) {
  Image map = SmoothMap(64, 128);
  for (int c = 0; c < 3; ++c) map.At(20, 20)[c] = 3e3f;
  problem_.kind = ProblemKind::kReflectance;
  problem_.known_map = map;
  problem_.map_width = map.width;
  problem_.map_height = map.height;
  problem_.solver.max_iterations = 12;
  std::vector<double> L_o(3 * problem_.points.size());
  ReferenceRenderer(map, {}).Render(
      problem_.points,
      [&](double h, double d, double p) { return truth_.Evaluate(h, d, p); },
      L_o.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    problem_.image.rgb[3 * problem_.points[i / 3].pixel + i % 3] =
        static_cast<float>(L_o[i]);
  }
  const Solution e = Solve();
  EXPECT_EQ(StatusCode::kOk, e.status.code()) << e.status.message();
  EXPECT_LT(e.misfit, kSunMisfit);
  EXPECT_EQ(map.rgb, e.map.rgb);
}

TEST_F(InverseRenderingTest, TheImagesUnitMovesTheMapAlone) {
  SetKind(ProblemKind::kIllumination);
  // To the end: on the way rounding may take another length of a step.
  problem_.solver.max_iterations = 8;
  const Solution one = Solve();
  // A power of two rounds nothing.
  for (float& v : problem_.image.rgb) v *= 1024.0f;
  const Solution scaled = Solve();
  // Rounding, amplified by the iterations.
  EXPECT_NEAR(one.misfit, scaled.misfit, 0.05 * one.misfit);
  for (size_t i = 0; i < one.map.rgb.size(); ++i) {
    EXPECT_NEAR(std::log(one.map.rgb[i] * 1024), std::log(scaled.map.rgb[i]),
                0.05);
  }
}

// Another gauge moves scale between the two and leaves all else as it is.
TEST_F(InverseRenderingTest, GaugesDifferByScaleAlone) {
  problem_.solver.gauge = SolverGauge::kPrior;
  const Solution prior = Solve();
  problem_.solver.gauge = SolverGauge::kUnitLight;
  const Solution unit = Solve();
  EXPECT_EQ(prior.render.rgb, unit.render.rgb);
  EXPECT_EQ(prior.misfit, unit.misfit);
  EXPECT_EQ(prior.spread, unit.spread);
  const Eigen::Array3d mean = MeanRadiance(unit.map);
  EXPECT_LT((mean - 1.0).abs().maxCoeff(), 1e-5);
  const Eigen::Array3d factor = MeanRadiance(prior.map);  // to the reflectance
  EXPECT_GT((factor - 1.0).abs().minCoeff(), 1e-3);
  for (size_t i = 0; i < unit.lobe_parameters.size(); ++i) {
    // Seven of a lobe, the last three colours.
    const double moved = i % 7 < 4 ? 0.0 : std::log(factor[i % 7 - 4]);
    EXPECT_NEAR(prior.lobe_parameters[i] + moved, unit.lobe_parameters[i],
                1e-5);
  }
  for (int c = 0; c < 3; ++c) {
    for (int bin = 0; bin < kMerlBins; bin += 1001) {
      const double raw = prior.brdf.Raw(c, bin);
      EXPECT_NEAR(unit.brdf.Raw(c, bin), raw > 0.0 ? factor[c] * raw : raw,
                  1e-5 * std::abs(factor[c] * raw));
    }
  }
}

TEST_F(InverseRenderingTest, UNetPriorRunsEndToEnd) {
  problem_.illumination_prior = IlluminationPrior::kUNet;
  problem_.solver.max_iterations = 1;
  const Solution e = Solve();
  ExpectWhole(e);
  // Under constant light the reflectance found says little.
  const auto constant = std::find_if(
      e.trace.begin(), e.trace.end(),
      [](const TraceEntry& t) { return t.stage == "constant map"; });
  ASSERT_NE(e.trace.end(), constant);
  EXPECT_LT(e.misfit, constant->misfit);
}

// What joined pixels leave out is asked for where there is any: under the same
// light a mirror's image has edges, a matte one's none.
TEST_F(InverseRenderingTest, MirrorsMapsAreFoundFromFinerPixels) {
  SetKind(ProblemKind::kIllumination);
  problem_.illumination_prior = IlluminationPrior::kProcess;
  problem_.points = SpherePoints(96);
  problem_.image = Image(96, 96);
  problem_.solver.max_iterations = 30;
  problem_.solver.tolerance = 1e-4;
  problem_.transport.grid.h = 24;
  Image map = map_;
  for (int t = 0; t < 128; t += 5) map.rgb[3 * t + 1] *= 20.0f;
  for (const bool mirror : {true, false}) {
    CookTorrance brdf;
    brdf.diffuse.setConstant(mirror ? 0.05 : 0.5);
    brdf.specular.setConstant(mirror ? 1.0 : 0.0);
    brdf.roughness.setConstant(0.05);
    brdf.f0.setConstant(0.5);
    problem_.known_brdf =
        BrdfGrid::FromFunction(brdf.Function(), problem_.transport.grid);
    std::vector<double> L_o(3 * problem_.points.size());
    Transport(problem_.points, 8, 16, problem_.transport)
        .Render(*problem_.known_brdf, map.rgb.data(), L_o.data());
    for (size_t i = 0; i < L_o.size(); ++i) {
      problem_.image.rgb[3 * problem_.points[i / 3].pixel + i % 3] =
          static_cast<float>(L_o[i] * std::exp(0.02 * std::sin(11.0 * i)));
    }
    const Solution e = Solve();
    const bool fine =
        std::any_of(e.trace.begin(), e.trace.end(), [](const TraceEntry& t) {
          return t.stage.compare(0, 8, "fine map") == 0;
        });
    EXPECT_EQ(mirror, fine);
    EXPECT_LT(e.misfit, 0.05);
  }
}

// No material explains the image, and the start is what there is to write.
TEST_F(InverseRenderingTest, ASearchWithoutAnEndKeepsTheStart) {
  NeuralBrdfModel black = *problem_.model;
  for (float& colour : black.log_colours) colour = -1e4f;
  problem_.model = std::make_shared<const NeuralBrdfModel>(black);
  const Solution e = Solve();
  ExpectWhole(e);
  EXPECT_EQ(StatusCode::kNoImprovement, e.status.code());
  EXPECT_FALSE(e.start.empty());
}

// A channel in which nothing is reflected says nothing of the light there.
TEST_F(InverseRenderingTest, ABlackChannelTakesTheLevelOfTheOthers) {
  SetKind(ProblemKind::kIllumination);
  problem_.solver.max_iterations = 0;
  const size_t nodes = problem_.known_brdf->values.size() / 3;
  std::fill_n(problem_.known_brdf->values.begin(), nodes, 0.0f);
  const Solution e = Solve();
  const float* rgb = e.map.rgb.data();
  EXPECT_NEAR(std::log(rgb[0]), 0.5 * (std::log(rgb[1]) + std::log(rgb[2])),
              1e-4);
}

TEST_F(InverseRenderingTest, AMethodThatIsTooDenseIsRefusedAtOnce) {
  problem_.illumination_prior = IlluminationPrior::kUNet;
  problem_.solver.method = SolverMethod::kTrustRegion;
  for (const auto estimator :
       {SolverEstimator::kMarginal, SolverEstimator::kMaximum}) {
    problem_.solver.estimator = estimator;
    int reports = 0;
    const Status s =
        SolveInverseRendering(
            problem_, [&](const TraceEntry&, double) { ++reports; }, nullptr)
            .status();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code());
    EXPECT_NE(std::string::npos, s.message().find("solver.method"));
    EXPECT_EQ(0, reports);
  }
}

TEST_F(InverseRenderingTest, GivenScaleAndEpsilonAreUsed) {
  problem_.scale = 0.125;
  problem_.epsilon = 0.25;
  const Solution e = Solve();
  EXPECT_EQ(0.125, e.scale);
  EXPECT_EQ(0.25, e.epsilon);
}

}  // namespace
}  // namespace ibrdf
