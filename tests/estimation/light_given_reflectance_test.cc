#include "ibrdf/solvers/estimation/light_given_reflectance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/solve/ball_problem.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// The misfit of the binned pixels under the light of an estimate for which no
// time is left.
double MisfitWithoutTime(const LogMap& mode) {
  InverseProblem problem = BallProblem(10);
  problem.kind = ProblemKind::kIllumination;
  problem.solver.seconds = 0.0;
  const Image map = SmoothMap(8, 16);
  const FlowLobes lobes(*problem.model, 2, problem.transport.grid, 1);
  problem.known_brdf = lobes.Grid(TinyLobes().data());
  const std::vector<double> L_o =
      RenderTinyLobes(*problem.model, problem.points, map);
  for (size_t i = 0; i < L_o.size(); ++i) {
    problem.image.rgb[3 * problem.points[i / 3].pixel + i % 3] =
        static_cast<float>(L_o[i]);
  }
  const StatusOr<SolveSetup> setup = SetUp(problem);
  EXPECT_TRUE(setup.ok()) << setup.status().message();
  SolveContext context(problem, {}, nullptr);
  ReflectanceEstimate known;
  known.light.mode = mode;
  StatusOr<Estimate> estimate = EstimateLight(*setup, known, &context);
  EXPECT_TRUE(estimate.ok()) << estimate.status().message();
  EXPECT_EQ(0, context.iterations());
  return Evaluate("light", *setup, context, estimate->iterate,
                  estimate->pixels.get())
      .misfit;
}

TEST(LightGivenReflectance, IsTheSearchesWhereNoTimeIsLeft) {
  const Image map = SmoothMap(8, 16);
  LogMap mode({16, 8});
  for (int k = 0; k < 16 * 8; ++k) {
    for (int c = 0; c < 3; ++c) {
      mode.data()[c * 16 * 8 + k] = std::log(map.rgb[3 * k + c]);
    }
  }
  const double constant = MisfitWithoutTime(LogMap());
  EXPECT_GT(constant, 0.1);
  EXPECT_LT(MisfitWithoutTime(mode), 0.3 * constant);
}

}  // namespace
}  // namespace ibrdf
