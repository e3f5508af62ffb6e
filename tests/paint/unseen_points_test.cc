#include "ibrdf/solvers/paint/unseen_points.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

namespace ibrdf {
namespace {

// A variance of 64 draws has a relative deviation of 0.18; four of these.
constexpr double kOfDraws = 0.72;

std::vector<NeighbourPair> Chain(int points) {
  std::vector<NeighbourPair> pairs;
  for (int i = 0; i + 1 < points; ++i) pairs.push_back({i, i + 1, 0.0});
  return pairs;
}

std::vector<NeighbourPair> Grid(int side) {
  std::vector<NeighbourPair> pairs;
  for (int i = 0; i < side * side; ++i) {
    if (i % side + 1 < side) pairs.push_back({i, i + 1, 0.0});
    if (i / side + 1 < side) pairs.push_back({i, i + side, 0.0});
  }
  return pairs;
}

// Steps of a chain held at both ends are a Brownian bridge.
TEST(UnseenPoints, VarianceOfAChainIsThatOfABridge) {
  constexpr int kHole = 39;
  std::vector<double> seen(kHole + 2, 0.0);
  seen.front() = seen.back() = 1.0;
  const UnseenPoints unseen(Chain(kHole + 2), seen);
  ASSERT_EQ(kHole, unseen.count());
  const Eigen::VectorXd variances = unseen.Variances();
  for (int k = 0; k < kHole; ++k) {
    const double from = k + 1, to = kHole - k;
    const double bridge = from * to / (from + to);
    EXPECT_NEAR(1.0, variances[k] / bridge, kOfDraws) << k;
  }
}

TEST(UnseenPoints, VarianceOfAHoleIsThatOfTheDenseInverse) {
  constexpr int kSide = 12;
  const std::vector<NeighbourPair> pairs = Grid(kSide);
  std::vector<double> seen(kSide * kSide, 1.0);
  std::vector<int> hole;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int x = i % kSide, y = i / kSide;
    if (x < 2 || x > 8 || y < 3 || y > 9) continue;
    seen[i] = 0.0;
    hole.push_back(i);
  }
  Eigen::MatrixXd precision =
      Eigen::MatrixXd::Zero(kSide * kSide, kSide * kSide);
  for (const NeighbourPair& pair : pairs) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(kSide * kSide);
    step[pair.first] = -1.0;
    step[pair.second] = 1.0;
    precision += step * step.transpose();
  }
  const Eigen::MatrixXd exact = precision(hole, hole).inverse();
  const Eigen::VectorXd variances = UnseenPoints(pairs, seen).Variances();
  double ratio = 0.0;
  for (size_t k = 0; k < hole.size(); ++k) {
    const double one = variances[k] / exact(k, k);
    EXPECT_NEAR(1.0, one, kOfDraws) << k;
    ratio += one / static_cast<double>(hole.size());
  }
  EXPECT_NEAR(1.0, ratio, 0.1);
}

TEST(UnseenPoints, MeanInterpolates) {
  std::vector<double> seen = {1.0, 0.0, 0.0, 0.0, 1.0};
  std::vector<double> values = {1.0, 99.0, 99.0, 99.0, 3.0};
  const UnseenPoints unseen(Chain(5), seen);
  unseen.Scatter(unseen.MeanGiven(values, 7.0), &values);
  const double expected[] = {1.0, 1.5, 2.0, 2.5, 3.0};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(expected[i], values[i], 1e-6) << i;
}

// The pair 3, 4 has no neighbour that is seen.
TEST(UnseenPoints, AHoleThatNothingSurroundsIsAlone) {
  const std::vector<double> seen = {1.0, 0.0, 1.0, 0.0, 0.0};
  std::vector<double> values = {1.0, 0.0, 1.0, 0.0, 0.0};
  const UnseenPoints unseen({{0, 1, 0.0}, {1, 2, 0.0}, {3, 4, 0.0}}, seen);
  unseen.Scatter(unseen.MeanGiven(values, 7.0), &values);
  EXPECT_NEAR(1.0, values[1], 1e-6);
  EXPECT_NEAR(7.0, values[3], 1e-6);
  EXPECT_NEAR(7.0, values[4], 1e-6);
  EXPECT_GT(unseen.Variances()[2], 1e3);
}

TEST(UnseenPoints, NoneAreFine) {
  const UnseenPoints unseen(Chain(3), {1.0, 1.0, 1.0});
  EXPECT_EQ(0, unseen.count());
  EXPECT_EQ(0, unseen.Variances().size());
  EXPECT_EQ(0, unseen.MeanGiven({1.0, 2.0, 3.0}, 1.0).size());
}

}  // namespace
}  // namespace ibrdf
