#include "ibrdf/solvers/segmentation/label_spreading.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

std::vector<ShadingPoint> At(const std::vector<int>& pixels) {
  std::vector<ShadingPoint> points;
  for (const int pixel : pixels) {
    ShadingPoint point;
    point.normal = point.wo = Eigen::Vector3f::UnitZ();
    point.pixel = pixel;
    point.coverage = 1.0f;
    points.push_back(point);
  }
  return points;
}

// Of four columns:
//   0 1 . 3
//   4 . . 7
TEST(SpreadLabels, GoesOverTheObjectBeforeItJumps) {
  std::vector<int> labels = {5, -1, 8, -1, -1};
  SpreadLabels(At({0, 1, 3, 4, 7}), 4, &labels);
  EXPECT_EQ((std::vector<int>{5, 5, 8, 5, 8}), labels);
}

// The end of a row does not touch the next one's beginning.
TEST(SpreadLabels, RowsEnd) {
  std::vector<int> labels = {1, -1, 2};
  SpreadLabels(At({3, 4, 9}), 4, &labels);
  EXPECT_EQ(2, labels[1]);
}

TEST(SpreadLabels, TheNearestIsTakenWhereThereIsNoWay) {
  std::vector<int> labels = {1, -1, 2};
  SpreadLabels(At({0, 3, 5}), 6, &labels);
  EXPECT_EQ(2, labels[1]);
}

}  // namespace
}  // namespace ibrdf
