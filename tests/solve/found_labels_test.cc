#include "ibrdf/solvers/solve/found_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kFoundSize = 24;  // pixels a side

// A ball of two materials, one of them right of the middle, or of one, under a
// smooth map.
class FoundLabelsTest : public ::testing::Test {
 protected:
  FoundLabelsTest() {
    problem_.variation = ReflectanceVariation::kLabels;
    problem_.solver.max_iterations = 1;
  }
  void Show(bool two) {
    std::vector<ShadingPoint> points = problem_.points;
    for (ShadingPoint& p : points) {
      p.material = two && p.pixel % kFoundSize >= kFoundSize / 2 ? 1 : 0;
    }
    SetNoisyImage(RadianceOfTwo(problem_, points, map_), 0.005, &problem_);
    truth_.clear();
    for (const ShadingPoint& p : points) truth_.push_back(p.material);
  }
  FoundLabels Find(const std::atomic<bool>* stop = nullptr) const {
    SolveContext context(problem_, nullptr, stop);
    return FindLabels(problem_, &context);
  }
  // The share of the points, by the better naming of two labels.
  double ShareRight(const std::vector<int>& labels) const {
    double same = 0.0;
    for (size_t i = 0; i < labels.size(); ++i) same += labels[i] == truth_[i];
    same /= static_cast<double>(labels.size());
    return std::max(same, 1.0 - same);
  }

  const Image map_ = SmoothMap(8, 16);
  InverseProblem problem_ = BallProblem(kFoundSize);
  std::vector<int> truth_;
};

TEST_F(FoundLabelsTest, TwoMaterialsAreToldAndEstimated) {
  Show(/*two=*/true);
  const StatusOr<Solution> e =
      SolveInverseRendering(problem_, nullptr, nullptr);
  ASSERT_TRUE(e.ok()) << e.status().message();
  EXPECT_EQ(2u, e->materials.size());
  EXPECT_LT(e->misfit, 0.05);
  const FoundLabels& found = e->found_labels;
  EXPECT_EQ(1, *std::max_element(found.labels.begin(), found.labels.end()));
  EXPECT_GT(ShareRight(found.labels), 0.95);
  EXPECT_GT(found.gain, 100.0);
  EXPECT_FALSE(found.cut_short);
  // The first has the most points.
  const auto ones = std::count(found.labels.begin(), found.labels.end(), 1);
  EXPECT_LE(2 * static_cast<size_t>(ones), found.labels.size());
}

TEST_F(FoundLabelsTest, OneMaterialStaysOne) {
  Show(/*two=*/false);
  const FoundLabels found = Find();
  ASSERT_EQ(problem_.points.size(), found.labels.size());
  EXPECT_EQ(0, *std::max_element(found.labels.begin(), found.labels.end()));
  EXPECT_EQ(0.0, found.gain);
}

TEST_F(FoundLabelsTest, BlackImageIsOfOneMaterial) {
  const FoundLabels found = Find();
  ASSERT_EQ(problem_.points.size(), found.labels.size());
  EXPECT_EQ(0, *std::max_element(found.labels.begin(), found.labels.end()));
}

TEST_F(FoundLabelsTest, SaysThatItWasCutShort) {
  Show(/*two=*/true);
  const std::atomic<bool> stop(true);
  const FoundLabels found = Find(&stop);
  EXPECT_TRUE(found.cut_short);
  EXPECT_EQ(0, *std::max_element(found.labels.begin(), found.labels.end()));
}

}  // namespace
}  // namespace ibrdf
