#include "ibrdf/solvers/solve/painted_known_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/brdf/matte_split.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/solve/paint_evidence.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/solve/plastic_ball.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kPaintedSize = 32;  // pixels a side

// A ball of the model's first material under a smooth map, its matte part in
// four paints.
class PaintedUnderKnownLightTest : public ::testing::Test {
 protected:
  PaintedUnderKnownLightTest() {
    problem_.kind = ProblemKind::kReflectance;
    problem_.variation = ReflectanceVariation::kAlbedo;
    problem_.known_map = map_;
    problem_.solver.max_iterations = 12;
    const FlowLobes lobes(*problem_.model, 2, problem_.transport.grid, 1);
    const std::vector<double> parameters = {0.3,  -0.4, 0.2,  0.1, 5.0,
                                            4.6,  4.2,  -0.5, 0.1, 0.3,
                                            -0.2, 3.0,  3.5,  3.3};
    whole_ = lobes.Grid(parameters.data());
    matte_ = lobes.Combine(parameters.data(),
                           MatteShapes(lobes, parameters.data()), 1);
    Paint();
  }

  std::vector<double> Render(const BrdfGrid& brdf) const {
    const Transport transport(problem_.points, 8, 16, problem_.transport);
    std::vector<double> L_o(3 * problem_.points.size());
    transport.Render(brdf, map_.rgb.data(), L_o.data());
    return L_o;
  }
  Eigen::Array3d LogPaint(const ShadingPoint& point) const {
    const Eigen::Array3d paints[] = {{0.5, 0.2, -0.3},
                                     {-0.5, -0.9, -1.0},
                                     {-0.8, -0.3, 0.4},
                                     {0.2, 0.4, 0.1}};
    const int x = point.pixel % kPaintedSize, y = point.pixel / kPaintedSize;
    return paints[(x / 8 + 3 * (y / 8)) % 4];
  }
  void Paint() {
    const std::vector<double> whole = Render(whole_), matte = Render(matte_);
    for (size_t i = 0; i < problem_.points.size(); ++i) {
      const Eigen::Array3d a = LogPaint(problem_.points[i]).exp();
      for (int c = 0; c < 3; ++c) {
        const size_t k = 3 * i + c;
        problem_.image.rgb[3 * problem_.points[i].pixel + c] =
            static_cast<float>(a[c] * matte[k] + whole[k] - matte[k]);
      }
    }
  }
  void Unpaint() {
    const std::vector<double> whole = Render(whole_);
    for (size_t k = 0; k < whole.size(); ++k) {
      problem_.image.rgb[3 * problem_.points[k / 3].pixel + k % 3] =
          static_cast<float>(whole[k]);
    }
  }
  Solution Solve() const {
    const StatusOr<Solution> e =
        SolveInverseRendering(problem_, nullptr, nullptr);
    EXPECT_TRUE(e.ok()) << e.status().message();
    return *e;
  }
  // Deviation of log albedo from the paint's, each channel about its mean.
  double AlbedoError(const Solution& e) const {
    const auto n = static_cast<Eigen::Index>(problem_.points.size());
    Eigen::Array3Xd d(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const float* a = &e.albedo.rgb[3 * problem_.points[i].pixel];
      for (int c = 0; c < 3; ++c) {
        d(c, i) = std::log(a[c]) - LogPaint(problem_.points[i])[c];
      }
    }
    d.colwise() -= d.rowwise().mean().eval();
    return std::sqrt(d.square().mean());
  }

  // The share of points whose luminance is off by less than so many of the
  // stated deviations.
  double ShareWithin(double deviations, const Solution& e) const {
    std::vector<double> off;
    for (const ShadingPoint& point : problem_.points) {
      const float* a = &e.albedo.rgb[3 * point.pixel];
      off.push_back(std::log(a[0] * a[1] * a[2]) / 3.0 -
                    LogPaint(point).mean());
    }
    const auto n = static_cast<double>(off.size());
    const double mean = std::accumulate(off.begin(), off.end(), 0.0) / n;
    double within = 0.0;
    for (size_t i = 0; i < off.size(); ++i) {
      const float std = e.albedo_log_std.rgb[3 * problem_.points[i].pixel];
      within += std::abs(off[i] - mean) < deviations * std ? 1.0 / n : 0.0;
    }
    return within;
  }

  InverseProblem problem_ = BallProblem(kPaintedSize);
  const Image map_ = SmoothMap(8, 16);
  BrdfGrid whole_, matte_;
};

TEST_F(PaintedUnderKnownLightTest, FindsThePaint) {
  const Solution e = Solve();
  // Constant albedo has 0.5.
  EXPECT_LT(AlbedoError(e), 0.1);
  EXPECT_LT(e.misfit, 0.05);
  EXPECT_EQ(map_.rgb, e.map.rgb);
  for (const ShadingPoint& point : problem_.points) {
    const size_t at = size_t{3} * point.pixel;
    EXPECT_NEAR(std::log(e.render.rgb[at]), std::log(problem_.image.rgb[at]),
                0.5);
    EXPECT_GE(e.gloss.rgb[at], 0.0f);
    EXPECT_GT(e.albedo_log_std.rgb[at], 0.0f);
    EXPECT_LT(e.albedo_log_std.rgb[at], 0.5f);
  }
  EXPECT_GT(ShareWithin(1.64, e), 0.75);
  EXPECT_LT(ShareWithin(0.1, e), 0.5);
}

TEST_F(PaintedUnderKnownLightTest, UnitsDoNotChangeTheDeviation) {
  problem_.solver.max_iterations = 1;
  const Solution before = Solve();
  for (float& v : problem_.image.rgb) v *= 64.0f;
  for (float& v : problem_.known_map->rgb) v *= 64.0f;
  EXPECT_EQ(before.albedo_log_std.rgb, Solve().albedo_log_std.rgb);
}

TEST_F(PaintedUnderKnownLightTest, IsSoughtWhereOneMaterialFails) {
  problem_.variation = ReflectanceVariation::kAuto;
  problem_.solver.max_iterations = 40;  // of both estimates together
  EXPECT_LT(AlbedoError(Solve()), 0.1);
  Unpaint();
  EXPECT_FALSE(Solve().has_paint());
}

// The light is unknown, so that mirrored light could explain paint.
TEST_F(PaintedUnderKnownLightTest, EvidenceTellsPaintFromLight) {
  problem_.kind = ProblemKind::kJoint;
  problem_.known_map.reset();
  const auto is_painted = [this] {
    const StatusOr<SolveSetup> setup = ibrdf::SetUp(problem_);
    EXPECT_TRUE(setup.ok()) << setup.status().message();
    SolveContext context(problem_, nullptr, nullptr);
    return IsProbablyPainted(*setup, &context);
  };
  EXPECT_TRUE(is_painted());
  Unpaint();
  EXPECT_FALSE(is_painted());
}

// Without the key the paint is in no albedo, and the misfit is its.
TEST_F(PaintedUnderKnownLightTest, OneMaterialDoesNotExplainIt) {
  problem_.variation = ReflectanceVariation::kNone;
  const Solution e = Solve();
  EXPECT_TRUE(e.albedo.rgb.empty());
  EXPECT_TRUE(e.albedo_log_std.rgb.empty());
  EXPECT_GT(e.misfit, 0.2);
}

TEST_F(PaintedUnderKnownLightTest, BlackPaintAndAHoleStayFinite) {
  for (size_t i = 0; i < problem_.points.size(); i += 7) {
    for (int c = 0; c < 3; ++c) {
      problem_.image.rgb[3 * problem_.points[i].pixel + c] =
          i % 2 == 0 ? 0.0f : 1e-12f;
    }
  }
  const Solution e = Solve();
  for (const ShadingPoint& point : problem_.points) {
    for (int c = 0; c < 3; ++c) {
      const float a = e.albedo.rgb[size_t{3} * point.pixel + c];
      EXPECT_TRUE(std::isfinite(a) && a > 0.0f);
    }
    const float std = e.albedo_log_std.rgb[size_t{3} * point.pixel];
    EXPECT_TRUE(std::isfinite(std) && std > 0.0f);
  }
}

TEST_F(PaintedUnderKnownLightTest, NoTimeLeavesAWholeEstimate) {
  problem_.solver.seconds = 1e-3;
  const Solution e = Solve();
  EXPECT_FALSE(e.albedo.rgb.empty());
  EXPECT_FALSE(e.lobe_parameters.empty());
}

// Its edges alone say nothing.
TEST(PaintThatFades, IsFoundUnderKnownLight) {
  InverseProblem problem =
      BallInRoom(ibrdf::Lambertian{{0.4, 0.3, 0.2}}.Function(), Stripes);
  problem.kind = ProblemKind::kReflectance;
  problem.variation = ReflectanceVariation::kAlbedo;
  const StatusOr<Solution> e = SolveInverseRendering(problem, nullptr, nullptr);
  ASSERT_TRUE(e.ok()) << e.status().message();
  std::vector<double> off, paint;
  for (const ShadingPoint& point : problem.points) {
    const float* a = &e->albedo.rgb[size_t{3} * point.pixel];
    paint.push_back(Stripes(point.normal));
    off.push_back(std::log(a[0] * a[1] * a[2]) / 3.0 - paint.back());
  }
  const auto deviation = [](const std::vector<double>& values) {
    const Eigen::Map<const Eigen::ArrayXd> v(
        values.data(), static_cast<Eigen::Index>(values.size()));
    return std::sqrt((v - v.mean()).square().mean());
  };
  EXPECT_GT(deviation(paint), 0.35);
  // The tiny model has no lobe that is quite matte. Edges alone leave 0.38.
  EXPECT_LT(deviation(off), 0.3);
}

}  // namespace
}  // namespace ibrdf
