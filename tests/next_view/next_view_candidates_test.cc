#include "ibrdf/solvers/next_view/next_view_candidates.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ibrdf/io/atomic_file.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

class NextViewCandidatesTest : public ::testing::Test {
 protected:
  NextViewCandidatesTest() { object_.radiance = Image(20, 10); }

  std::string Refusal(const std::string& text) const {
    const Status status =
        LoadNextViewCandidates(problem_, object_, text, 1).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << text;
    return status.message();
  }

  Problem problem_;
  PhotographedObject object_;
};

TEST_F(NextViewCandidatesTest, SpreadAboutTheObject) {
  object_.scene = Scene::Sphere({1.0, 2.0, 3.0}, 0.5);
  const NextViewCandidates found =
      LoadNextViewCandidates(problem_, object_, "sphere:12", 1).value();
  ASSERT_EQ(12u, found.views.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (size_t k = 0; k < 12; ++k) {
    const Eigen::Vector3d from =
        found.views[k].world_from_camera.topRightCorner<3, 1>();
    sum += from;
    EXPECT_NEAR((found.views[0].world_from_camera.topRightCorner<3, 1>() -
                 Eigen::Vector3d(1.0, 2.0, 3.0))
                    .norm(),
                (from - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-9);
    // All of the front is seen, from each place.
    ASSERT_GT(found.points[k].size(), 100u);
    ASSERT_LE(found.points[k].size(), 1000u);
    for (size_t i = 0; i < found.points[k].size(); ++i) {
      EXPECT_EQ(static_cast<int>(i), found.points[k][i].index);
    }
  }
  EXPECT_LT((sum / 12.0 - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 0.3);
}

TEST_F(NextViewCandidatesTest, KeepsThePhotographsDistanceAndLens) {
  problem_.camera.type = CameraType::kPerspective;
  problem_.camera.from = {0.0, 0.0, 7.0};
  const NextViewCandidates found =
      LoadNextViewCandidates(problem_, object_, "sphere:5", 1).value();
  for (const CalibratedView& view : found.views) {
    EXPECT_NEAR(7.0, (view.world_from_camera.topRightCorner<3, 1>().norm()),
                1e-9);
    EXPECT_EQ(20.0, view.width);
    EXPECT_EQ(10.0, view.height);
  }
}

// A camera that looks past the object counts as one that sees nothing; where
// none sees it, nothing can be chosen.
TEST_F(NextViewCandidatesTest, BlindOnesAreKeptWithoutPoints) {
  NextViewCandidates found =
      LoadNextViewCandidates(problem_, object_, "sphere:2", 1).value();
  const TempDir dir;
  Eigen::Matrix4d& pose = found.views[1].world_from_camera;
  pose.topLeftCorner<3, 3>() = Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal() *
                               pose.topLeftCorner<3, 3>();
  const Eigen::Vector3d from = pose.topRightCorner<3, 1>();
  pose.topRightCorner<3, 1>() = 3.0 * from + 20.0 * pose.col(0).head<3>();
  const std::string path = dir.File("candidates.json");
  ASSERT_TRUE(
      WriteFileAtomically(path, NextViewsText(found.views, {0, 1}, UpAxis::kY))
          .ok());
  const NextViewCandidates read =
      LoadNextViewCandidates(problem_, object_, path, 1).value();
  ASSERT_EQ(2u, read.points.size());
  EXPECT_FALSE(read.points[0].empty());
  EXPECT_TRUE(read.points[1].empty());
  ASSERT_TRUE(
      WriteFileAtomically(path, NextViewsText(found.views, {1}, UpAxis::kY))
          .ok());
  EXPECT_EQ(
      "command line: --candidates: expected a camera that sees the object: "
      "none of 1 does",
      Refusal(path));
}

TEST_F(NextViewCandidatesTest, RefusesWhatCannotBeChosenFor) {
  problem_.path = "p.yaml";
  EXPECT_EQ(0u, Refusal("sphere:0").find("command line: --candidates"));
  EXPECT_EQ(0u, Refusal("sphere:1001").find("command line: --candidates"));
  EXPECT_NE(std::string::npos, Refusal("none.json").find("none.json"));
  problem_.kind = ProblemKind::kReflectance;
  EXPECT_EQ(0u, Refusal("sphere:3").find("p.yaml: problem: expected joint"));
  problem_.kind = ProblemKind::kJoint;
  problem_.geometry.kind = GeometryKind::kNormals;
  EXPECT_EQ(0u,
            Refusal("sphere:3").find("p.yaml: geometry: expected a sphere"));
  problem_.geometry.kind = GeometryKind::kDepth;
  EXPECT_EQ(0u,
            Refusal("sphere:3").find("p.yaml: geometry: expected a sphere"));
  problem_.geometry.kind = GeometryKind::kMesh;
  problem_.solver.estimator = SolverEstimator::kMaximum;
  EXPECT_EQ(0u, Refusal("sphere:3").find("p.yaml: solver.estimator"));
  problem_.solver.estimator = SolverEstimator::kMarginal;
  for (const auto variation :
       {ReflectanceVariation::kAlbedo, ReflectanceVariation::kLabels}) {
    problem_.reflectance.variation = variation;
    EXPECT_EQ(0u, Refusal("sphere:3").find("p.yaml: reflectance.variation"));
  }
}

}  // namespace
}  // namespace ibrdf
