#include "ibrdf/solvers/solve/paint_turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/solve/plastic_ball.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Sectors of red, white and blue paint.
Eigen::Array3d Patches(const Eigen::Vector3f& normal) {
  const double angle = std::atan2(normal.y() - 0.1, normal.x() + 0.15);
  const int sector = static_cast<int>(std::floor((angle + 3.2) / 1.1)) % 3;
  if (sector == 0) return {0.3, -0.8, -1.0};
  return sector == 1 ? Eigen::Array3d(-1.1, -0.7, 0.2)
                     : Eigen::Array3d(0.4, 0.3, 0.2);
}

std::optional<MapTurns> PaintTurnsOf(const InverseProblem& problem) {
  const StatusOr<SolveSetup> setup = SetUp(problem);
  EXPECT_TRUE(setup.ok()) << setup.status().message();
  return FindPaintTurns(*setup);
}

TEST(FindPaintTurns, FindsWhatUndoesATurn) {
  InverseProblem problem = PaintedBall(Patches);
  const std::optional<MapTurns> right = PaintTurnsOf(problem);
  ASSERT_TRUE(right.has_value());
  EXPECT_FALSE(IsBetterOfPaint(*right));
  const Image map = *problem.known_map;
  for (const bool mirrored : {false, true}) {
    problem.known_map = Turned(map, mirrored, 12);
    const std::optional<MapTurns> turns = PaintTurnsOf(problem);
    ASSERT_TRUE(turns.has_value());
    EXPECT_TRUE(IsBetterOfPaint(*turns));
    EXPECT_EQ(mirrored, turns->best.mirrored);
    EXPECT_EQ((mirrored ? 12 : 20) * 360.0 / 32, turns->best.degrees);
    EXPECT_NEAR(right->best.misfit, turns->best.misfit, 0.002);
  }
}

// Its shading could be another map's.
TEST(FindPaintTurns, PaintThatFadesSaysNothing) {
  EXPECT_FALSE(PaintTurnsOf(PlasticBall(Stripes)).has_value());
}

// Rims of coloured highlights are sharp as well.
TEST(FindPaintTurns, WithoutPaintTheRightFrameIsRight) {
  const std::optional<MapTurns> turns = PaintTurnsOf(PlasticBall(NoPaint));
  EXPECT_FALSE(turns.has_value() && IsBetterOfPaint(*turns));
}

TEST(FindPaintTurns, EvenLightHasNone) {
  InverseProblem problem = PaintedBall(Patches);
  std::fill(problem.known_map->rgb.begin(), problem.known_map->rgb.end(), 1.0f);
  const std::optional<MapTurns> turns = PaintTurnsOf(problem);
  EXPECT_FALSE(turns.has_value() && IsBetterOfPaint(*turns));
}

// The error of a matte ball's log albedo is what the shading under the wrong
// map lacks.
TEST(DoubtAlbedo, StatesWhatTheTurnWouldChange) {
  const BrdfFunction matte =
      ibrdf::Lambertian{Eigen::Array3d::Constant(0.3)}.Function();
  InverseProblem problem = BallInRoom(matte, Patches, 72);
  problem.known_map = Turned(*problem.known_map, true, 12);
  const Transport transport(problem.points, problem.map_height,
                            problem.map_width, problem.transport);
  std::vector<double> shading(3 * problem.points.size());
  transport.Render(BrdfGrid::FromFunction(matte, problem.transport.grid),
                   problem.known_map->rgb.data(), shading.data());
  const StatusOr<SolveSetup> setup = ibrdf::SetUp(problem);
  ASSERT_TRUE(setup.ok()) << setup.status().message();
  constexpr float kBefore = 0.1f;
  Solution solution;
  solution.albedo_log_std = problem.image;
  std::fill(solution.albedo_log_std.rgb.begin(),
            solution.albedo_log_std.rgb.end(), kBefore);
  DoubtAlbedo(*setup, {true, 12 * 360.0 / 32, 0.0}, &solution);

  const auto points = static_cast<Eigen::Index>(problem.points.size());
  Eigen::ArrayXd errors(points), stated(points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const ShadingPoint& point = problem.points[i];
    const size_t at = 3 * static_cast<size_t>(point.pixel);
    const auto I = Eigen::Map<const Eigen::Array3f>(&problem.image.rgb[at]);
    const auto S = Eigen::Map<const Eigen::Array3d>(&shading[3 * i]);
    errors[i] =
        (I.cast<double>().log() - S.log() - Patches(point.normal)).mean();
    stated[i] = solution.albedo_log_std.rgb[at];
  }
  errors -= errors.mean();
  EXPECT_GT(std::sqrt(errors.square().mean()), 0.3);
  const Eigen::ArrayXd expected =
      (errors.square() + std::pow(kBefore, 2)).sqrt();
  EXPECT_LT((stated - expected).abs().mean(), 0.02);  // noise: 0.01
}

TEST(SolveInverseRendering, DoubtsAPaintedObjectsMapInAnotherFrame) {
  InverseProblem problem = PaintedBall(Patches);
  StatusOr<Solution> solution = SolvedWithAutoPaint(problem);
  ASSERT_TRUE(solution.ok()) << solution.status().message();
  EXPECT_TRUE(solution->has_paint());
  EXPECT_FALSE(solution->better_map_turn.has_value());
  const auto sum_of = [](const Image& image) {
    return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0);
  };
  const double right_deviations = sum_of(solution->albedo_log_std);

  problem.known_map = Turned(*problem.known_map, true, 0);
  solution = SolvedWithAutoPaint(problem);
  ASSERT_TRUE(solution.ok()) << solution.status().message();
  EXPECT_TRUE(solution->has_paint());
  ASSERT_TRUE(solution->better_map_turn.has_value());
  EXPECT_TRUE(solution->map_turn_of_paint);
  EXPECT_TRUE(solution->better_map_turn->mirrored);
  EXPECT_EQ(0.0, solution->better_map_turn->degrees);
  EXPECT_GT(sum_of(solution->albedo_log_std), 1.3 * right_deviations);
}

}  // namespace
}  // namespace ibrdf
