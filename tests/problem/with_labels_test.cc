#include "ibrdf/solvers/problem/with_labels.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(WithLabels, CountsAndNamesThem) {
  InverseProblem problem;
  problem.image = Image(4, 1);
  problem.points.resize(4);
  for (int i = 0; i < 4; ++i) problem.points[i].pixel = i;
  const InverseProblem labelled = WithLabels(problem, {1, 0, 1, 1});
  ASSERT_EQ(2u, labelled.materials.size());
  EXPECT_EQ("1", labelled.materials[0].value);
  EXPECT_EQ(1u, labelled.materials[0].pixels);
  EXPECT_EQ("2", labelled.materials[1].value);
  EXPECT_EQ(3u, labelled.materials[1].pixels);
  EXPECT_EQ(0, labelled.points[1].material);
  EXPECT_EQ(1, labelled.points[3].material);
  // Labels that it had are gone.
  const InverseProblem again = WithLabels(labelled, {0, 0, 0, 0});
  ASSERT_EQ(1u, again.materials.size());
  EXPECT_EQ(4u, again.materials[0].pixels);
}

// Of three columns:
//   0 0 1
//   0 0 1
//   2 0 1
TEST(WithLabels, PointsAtSeamsAreMixed) {
  InverseProblem problem;
  problem.image = Image(3, 3);
  problem.points.resize(9);
  for (int i = 0; i < 9; ++i) problem.points[i].pixel = i;
  const std::vector<int> labels = {0, 0, 1, 0, 0, 1, 2, 0, 1};
  const std::vector<bool> beside = BesideOtherLabels(problem.points, 3, labels);
  EXPECT_EQ((std::vector<bool>{0, 1, 1, 1, 1, 1, 1, 1, 1}), beside);
  problem = WithLabels(problem, labels);
  for (int i = 0; i < 9; ++i) {
    // Nothing would be left of the others.
    EXPECT_EQ(labels[i] == 0 && beside[i], problem.points[i].mixed) << i;
  }
  problem = WithLabels(problem, std::vector<int>(9, 0));
  for (const ShadingPoint& p : problem.points) EXPECT_FALSE(p.mixed);
}

TEST(WithLabels, AllThatMayBeFoundHaveNames) {
  const std::vector<MaterialLabel> labels = LabelsToBeFound();
  ASSERT_EQ(static_cast<size_t>(kMostFoundLabels), labels.size());
  EXPECT_EQ("1", labels.front().value);
  EXPECT_EQ("5", labels.back().value);
}

}  // namespace
}  // namespace ibrdf
