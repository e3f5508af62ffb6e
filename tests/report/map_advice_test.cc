#include "ibrdf/solvers/report/map_advice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/base/pi.h"
#include "tests/report/contains.h"

namespace ibrdf {
namespace {

constexpr MapSize kSize = {64, 32};

bool IsLatLong(MapFrame frame) {
  return frame != MapFrame::kDebevecProbe && frame != MapFrame::kCubeCross;
}

// Mirrored in the plane x = 0, then turned about +y.
Eigen::Vector3d After(const MapTurn& turn, Eigen::Vector3d direction) {
  if (turn.mirrored) direction.x() = -direction.x();
  return Eigen::AngleAxisd(turn.degrees / 180.0 * kPi,
                           Eigen::Vector3d::UnitY()) *
         direction;
}

// What a texel shows by one frame comes, after the turn, to where it is by the
// other.
TEST(FrameAfter, ShowsEveryTexelWhereTheTurnBringsIt) {
  for (const MapFrame given : kMapFrames) {
    if (!IsLatLong(given) || given == MapFrame::kOpenExr) continue;
    int found = 0;
    for (int k = 0; k < 8; ++k) {
      const MapTurn turn = {k >= 4, 90.0 * (k % 4), 0.0};
      const auto after = FrameAfter(given, turn, 1.0);
      if (!after.has_value()) continue;
      ++found;
      SCOPED_TRACE(std::string(MapFrameName(given)) + " to " +
                   MapFrameName(*after));
      const MapGrid from(given, kSize), to(*after, kSize);
      for (int texel = 0; texel < 64 * 32; texel += 37) {
        EXPECT_TRUE(After(turn, *from.TexelDirection(texel))
                        .isApprox(*to.TexelDirection(texel), 1e-9));
      }
    }
    // Three others of camera, mitsuba, blender and ibrdf_0_1.
    EXPECT_EQ(3, found) << MapFrameName(given);
  }
}

TEST(FrameAfter, KnowsNoFrameForOtherTurns) {
  // The given one is no other.
  EXPECT_EQ(std::nullopt, FrameAfter(MapFrame::kCamera, {}, 1.0));
  EXPECT_EQ(std::nullopt,
            FrameAfter(MapFrame::kCamera, {false, 40.0, 0.0}, 6.0));
  EXPECT_EQ(MapFrame::kMitsuba,
            FrameAfter(MapFrame::kCamera, {false, 175.0, 0.0}, 6.0));
  EXPECT_EQ(std::nullopt,
            FrameAfter(MapFrame::kCamera, {false, 355.0, 0.0}, 6.0));
  EXPECT_EQ(std::nullopt, FrameAfter(MapFrame::kCubeCross, {}, 1.0));
}

TEST(MapTurnAdvice, NamesAFrameOrSaysTheTurn) {
  Problem problem;
  const InverseProblem inverse;
  const Truth truth;
  Solution solution;
  const ResultMetrics metrics;
  const SolvedProblem solved = {problem, inverse, truth, solution, metrics};
  EXPECT_EQ("", MapTurnAdvice(solved));
  solution.better_map_turn = {false, 180.0, 0.05};
  solution.misfit_of_given_map = 0.3;
  EXPECT_EQ(
      "try illumination.frame: mitsuba, as simple materials leave 0.05 under "
      "the map turned by 180 degrees to the left, and 0.3 under the map as it "
      "is given",
      MapTurnAdvice(solved));
  solution.map_turn_of_paint = true;
  EXPECT_EQ(
      "try illumination.frame: mitsuba, as places of like paint differ by 0.05 "
      "under the map turned by 180 degrees to the left, and by 0.3 under the "
      "map as it is given",
      MapTurnAdvice(solved));
  solution.map_turn_of_paint = false;
  solution.better_map_turn = {true, 315.0, 0.05};
  EXPECT_TRUE(Contains(MapTurnAdvice(solved),
                       "check illumination.frame, as simple materials leave "
                       "0.05 under the map mirrored left to right and turned "
                       "by 45 degrees to the right"))
      << MapTurnAdvice(solved);
  problem.illumination.sky.emplace();
  EXPECT_EQ(0u, MapTurnAdvice(solved).find("check the sky's directions, as"));
}

}  // namespace
}  // namespace ibrdf
