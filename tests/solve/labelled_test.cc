#include "ibrdf/solvers/solve/labelled.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kLabelledSize = 12;  // pixels a side

// A ball in quarters of two materials, under a smooth map.
class LabelledTest : public ::testing::Test {
 protected:
  LabelledTest() {
    problem_.kind = ProblemKind::kJoint;
    problem_.variation = ReflectanceVariation::kLabels;
    problem_.solver.max_iterations = 2;
    problem_.materials = {{"10", 0}, {"90", 0}};
    for (ShadingPoint& p : problem_.points) {
      const int x = p.pixel % kLabelledSize, y = p.pixel / kLabelledSize;
      p.material = (x < 5) != (y < 6) ? 1 : 0;
      ++problem_.materials[p.material].pixels;
    }
    const std::vector<double> L_o =
        RadianceOfTwo(problem_, problem_.points, map_);
    for (size_t i = 0; i < L_o.size(); ++i) {
      problem_.image.rgb[3 * problem_.points[i / 3].pixel + i % 3] =
          static_cast<float>(L_o[i] * std::exp(0.01 * std::sin(11.0 * i)));
    }
  }
  Solution Solve() const {
    const StatusOr<Solution> e =
        SolveInverseRendering(problem_, nullptr, nullptr);
    EXPECT_TRUE(e.ok()) << e.status().message();
    return *e;
  }
  void ExpectWhole(const Solution& e) const {
    ASSERT_EQ(size_t{2}, e.materials.size());
    for (const MaterialSolution& m : e.materials) {
      EXPECT_EQ(size_t{14}, m.lobe_parameters.size());
      ASSERT_EQ(size_t{3} * kMerlBins, m.brdf.raw.size());
      EXPECT_FALSE(m.start.empty());
      for (const double v : m.brdf.raw) ASSERT_TRUE(std::isfinite(v));
    }
    // The one of most pixels.
    const int main =
        problem_.materials[0].pixels < problem_.materials[1].pixels ? 1 : 0;
    EXPECT_EQ(e.materials[main].lobe_parameters, e.lobe_parameters);
    EXPECT_EQ(e.materials[main].brdf.raw, e.brdf.raw);
    for (const ShadingPoint& p : problem_.points) {
      EXPECT_GT(e.render.rgb[size_t{3} * p.pixel], 0.0f);
    }
    EXPECT_EQ(static_cast<int64_t>(problem_.points.size()), e.pixels_used);
  }
  // Mean log of the green channel over the table.
  static double Level(const MerlTable& brdf) {
    double sum = 0.0, count = 0.0;
    for (int i = kMerlBins; i < 2 * kMerlBins; ++i) {
      if (!(brdf.raw[i] > 0.0)) continue;
      sum += std::log(brdf.raw[i]);
      count += 1.0;
    }
    return sum / count;
  }
  double TrueLevel(int material) const {
    return Level(FlowLobes(*problem_.model, 2, problem_.transport.grid, 1)
                     .ToMerl(kTwoMaterials[material].data()));
  }

  const Image map_ = SmoothMap(8, 16);
  InverseProblem problem_ = BallProblem(kLabelledSize);
};

TEST_F(LabelledTest, MaterialsShareOneUnknownLight) {
  const Solution e = Solve();
  ExpectWhole(e);
  EXPECT_TRUE(e.status.ok()) << e.status.message();
  EXPECT_LT(e.misfit, 0.05);
  EXPECT_LT(e.end_cost, e.start_cost);
  EXPECT_FALSE(e.materials[0].lobe_covariance.empty());
  // Their scale is not known, but which is brighter, and by how much, is.
  EXPECT_NEAR(TrueLevel(0) - TrueLevel(1),
              Level(e.materials[0].brdf) - Level(e.materials[1].brdf), 0.3);
}

TEST_F(LabelledTest, EachIsAProblemOfItsOwnUnderKnownLight) {
  problem_.kind = ProblemKind::kReflectance;
  problem_.known_map = map_;
  const Solution e = Solve();
  ExpectWhole(e);
  EXPECT_LT(e.misfit, 0.05);
  for (int m = 0; m < 2; ++m) {
    EXPECT_NEAR(TrueLevel(m), Level(e.materials[m].brdf), 0.3) << m;
  }
}

// The bits of a problem without labels.
TEST_F(LabelledTest, OneLabelIsNone) {
  problem_.solver.max_iterations = 1;
  for (ShadingPoint& p : problem_.points) p.material = 0;
  problem_.materials = {{"10", problem_.points.size()}};
  const Solution one = Solve();
  problem_.materials.clear();
  problem_.variation = ReflectanceVariation::kNone;
  const Solution none = Solve();
  EXPECT_EQ(none.lobe_parameters, one.lobe_parameters);
  EXPECT_EQ(none.map.rgb, one.map.rgb);
  EXPECT_TRUE(none.materials.empty());
  ASSERT_EQ(size_t{1}, one.materials.size());
  EXPECT_EQ(one.brdf.raw, one.materials[0].brdf.raw);
}

TEST_F(LabelledTest, MaterialOfOnePixelIsEstimatedToo) {
  for (size_t i = 0; i < problem_.points.size(); ++i) {
    const int x = problem_.points[i].pixel % kLabelledSize;
    const int y = problem_.points[i].pixel / kLabelledSize;
    problem_.points[i].material = x == 7 && y == 7 ? 1 : 0;
  }
  problem_.materials = {{"10", problem_.points.size() - 1}, {"90", 1}};
  const Solution e = Solve();
  ExpectWhole(e);
}

TEST_F(LabelledTest, BlackImageOfOneLabelStillHasAnEstimate) {
  for (const ShadingPoint& p : problem_.points) {
    if (p.material == 1) {
      std::fill_n(&problem_.image.rgb[size_t{3} * p.pixel], 3, 0.0f);
    }
  }
  const Solution e = Solve();
  ASSERT_EQ(size_t{2}, e.materials.size());
  for (const MaterialSolution& m : e.materials) {
    for (const double v : m.brdf.raw) ASSERT_TRUE(std::isfinite(v));
  }
}

}  // namespace
}  // namespace ibrdf
