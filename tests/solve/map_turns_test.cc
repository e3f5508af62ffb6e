#include "ibrdf/solvers/solve/map_turns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/solve/plastic_ball.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

MapTurns TurnsOf(const InverseProblem& problem) {
  const StatusOr<SolveSetup> setup = SetUp(problem);
  EXPECT_TRUE(setup.ok()) << setup.status().message();
  return FindMapTurns(*setup);
}

TEST(Turned, BringsDirectionsWhereItSays) {
  const Image map = Room();
  for (const bool mirrored : {false, true}) {
    const Image turned = Turned(map, mirrored, 8);  // a quarter
    for (const Eigen::Vector3d& from :
         {Eigen::Vector3d(0.2, 0.3, 1.0), Eigen::Vector3d(-0.7, 0.4, 0.2)}) {
      const double x = mirrored ? -from.x() : from.x();
      // +z comes to +x, +x to -z.
      const Eigen::Vector3d to(from.z(), from.y(), -x);
      EXPECT_TRUE(LookUpMap(turned, to).isApprox(LookUpMap(map, from), 1e-5));
    }
  }
}

TEST(FindMapTurns, FindsWhatUndoesATurn) {
  InverseProblem problem = PlasticBall(NoPaint);
  const MapTurns right = TurnsOf(problem);
  EXPECT_LT(right.as_given, 0.06);
  EXPECT_FALSE(IsFarBetter(right));
  const Image map = *problem.known_map;
  for (const bool mirrored : {false, true}) {
    problem.known_map = Turned(map, mirrored, 12);
    const MapTurns turns = TurnsOf(problem);
    EXPECT_GT(turns.as_given, 0.2);
    EXPECT_TRUE(IsFarBetter(turns));
    EXPECT_NEAR(right.as_given, turns.best.misfit, 0.01);
    EXPECT_EQ(mirrored, turns.best.mirrored);
    // A mirrored turn undoes itself.
    EXPECT_EQ((mirrored ? 12 : 20) * 360.0 / 32, turns.best.degrees);
  }
}

// Whatever the map's size divides by.
TEST(FindMapTurns, TakesALargeMapCoarsely) {
  InverseProblem problem = PlasticBall(NoPaint);
  problem.known_map = ResizeMap(Turned(*problem.known_map, true, 0), 75, 150);
  problem.map_width = 150;
  problem.map_height = 75;
  const MapTurns turns = TurnsOf(problem);
  EXPECT_TRUE(IsFarBetter(turns));
  EXPECT_TRUE(turns.best.mirrored);
  EXPECT_NEAR(180.0, std::abs(turns.best.degrees - 180.0), 6.0);
}

TEST(FindMapTurns, PaintIsNoTurn) {
  const MapTurns turns = TurnsOf(PlasticBall(Stripes));
  EXPECT_GT(turns.as_given, 0.2);
  EXPECT_FALSE(IsFarBetter(turns));
}

TEST(FindMapTurns, EvenLightHasNone) {
  InverseProblem problem = PlasticBall(Stripes);
  std::fill(problem.known_map->rgb.begin(), problem.known_map->rgb.end(), 1.0f);
  const MapTurns turns = TurnsOf(problem);
  EXPECT_FALSE(IsFarBetter(turns));
  EXPECT_FALSE(turns.best.mirrored);
  EXPECT_EQ(0.0, turns.best.degrees);
}

// Under known light paint is what one material leaves; but not what another
// frame of the map explains.
TEST(SolveInverseRendering, TakesAMapInTheWrongFrameForNoPaint) {
  InverseProblem problem = PlasticBall(Stripes);
  StatusOr<Solution> solution = SolvedWithAutoPaint(problem);
  ASSERT_TRUE(solution.ok()) << solution.status().message();
  EXPECT_TRUE(solution->has_paint());
  EXPECT_FALSE(solution->better_map_turn.has_value());

  problem = PlasticBall(NoPaint);
  problem.known_map = Turned(*problem.known_map, true, 0);
  solution = SolvedWithAutoPaint(problem);
  ASSERT_TRUE(solution.ok()) << solution.status().message();
  EXPECT_FALSE(solution->has_paint());
  ASSERT_TRUE(solution->better_map_turn.has_value());
  EXPECT_TRUE(solution->better_map_turn->mirrored);
  EXPECT_EQ(0.0, solution->better_map_turn->degrees);
  EXPECT_LT(solution->better_map_turn->misfit,
            0.5 * solution->misfit_of_given_map);
}

}  // namespace
}  // namespace ibrdf
