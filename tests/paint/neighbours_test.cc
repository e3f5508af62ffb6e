#include "ibrdf/solvers/paint/neighbours.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

ShadingPoint At(int pixel, const Eigen::Vector3f& normal) {
  ShadingPoint point;
  point.normal = normal;
  point.wo = Eigen::Vector3f::UnitZ();
  point.pixel = pixel;
  point.coverage = 1.0f;
  return point;
}

// Three columns and two rows, one pixel missing:
//   0 1 .
//   3 4 5
TEST(NeighboursOf, ShareASideAndNoRowsEnd) {
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const std::vector<NeighbourPair> pairs =
      NeighboursOf({At(0, z), At(1, x), At(3, z), At(4, z), At(5, z)}, 3);
  ASSERT_EQ(pairs.size(), 5u);
  const int expected[5][2] = {{0, 1}, {0, 2}, {1, 3}, {2, 3}, {3, 4}};
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(pairs[k].first, expected[k][0]);
    EXPECT_EQ(pairs[k].second, expected[k][1]);
    const bool turns = pairs[k].first == 1 || pairs[k].second == 1;
    EXPECT_NEAR(pairs[k].turn, turns ? std::sqrt(2.0) : 0.0, 1e-6);
  }
}

// 1 ends the first row, 2 begins the second.
TEST(NeighboursOf, DoNotWrap) {
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  EXPECT_TRUE(NeighboursOf({At(1, z), At(2, z)}, 2).empty());
}

}  // namespace
}  // namespace ibrdf
