#include "ibrdf/geometry/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {
constexpr double kRounding = 1e-12;

TEST(Camera, OrthographicShorterSideSpansTheUnitSquare) {
  const Camera camera;
  const Ray corner = CameraRay(camera, 0, 0, 200, 100);
  EXPECT_NEAR(-2.0, corner.origin.x(), kRounding);
  EXPECT_NEAR(1.0, corner.origin.y(), kRounding);  // row 0 is the top
  EXPECT_TRUE(corner.direction.isApprox(-Eigen::Vector3d::UnitZ()));
  const Ray tall = CameraRay(camera, 100, 300, 100, 300);
  EXPECT_NEAR(1.0, tall.origin.x(), kRounding);
  EXPECT_NEAR(-3.0, tall.origin.y(), kRounding);
}

TEST(Camera, PerspectiveLooksAtItsTargetWithTheVerticalAngle) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.from = {3, 1, -2};
  camera.to = {0.5, -1, 0};
  camera.fov_degrees = 40;
  const Ray middle = CameraRay(camera, 80, 50, 160, 100);
  EXPECT_TRUE(
      middle.direction.isApprox((camera.to - camera.from).normalized()));
  const Ray top = CameraRay(camera, 80, 0, 160, 100);
  EXPECT_NEAR(20 * kPi / 180, std::acos(top.direction.dot(middle.direction)),
              1e-9);
  EXPECT_GT(top.direction.y(), middle.direction.y());
  const Ray right = CameraRay(camera, 160, 50, 160, 100);
  EXPECT_NEAR(1.6 * std::tan(20 * kPi / 180),
              std::tan(std::acos(right.direction.dot(middle.direction))), 1e-9);
  // Right-handed: right x up points back to the viewer.
  const Eigen::Vector3d r = right.direction - middle.direction;
  const Eigen::Vector3d u = top.direction - middle.direction;
  EXPECT_LT(r.cross(u).dot(middle.direction), 0.0);
}

TEST(Camera, RefusesDegenerateFields) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  EXPECT_TRUE(IsValidCamera(camera));
  Camera bad = camera;
  bad.to = bad.from;
  EXPECT_FALSE(IsValidCamera(bad));
  bad = camera;
  bad.up = {0, 0, 2};
  EXPECT_FALSE(IsValidCamera(bad));
  for (const double fov :
       {0.0, -1.0, 180.0, std::numeric_limits<double>::quiet_NaN()}) {
    bad = camera;
    bad.fov_degrees = fov;
    EXPECT_FALSE(IsValidCamera(bad));
  }
}

Eigen::Matrix4d Turned(double angle) {
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 2) / 3).matrix();
  pose.topRightCorner<3, 1>() = Eigen::Vector3d(0.3, -2, 5);
  return pose;
}

TEST(Camera, APoseStandsForFromToAndUp) {
  Camera looking;
  looking.type = CameraType::kPerspective;
  looking.from = {1, 2, 3};
  looking.to = {0, 0.5, 0};
  looking.fov_degrees = 35;
  Camera posed;
  posed.type = CameraType::kPerspective;
  const CameraAxes axes = AxesOf(looking);
  posed.world_from_camera = Eigen::Matrix4d::Identity();
  posed.world_from_camera->topLeftCorner<3, 3>() = axes.world_from_camera;
  posed.world_from_camera->topRightCorner<3, 1>() = looking.from;
  posed.focal_pixels =
      Eigen::Vector2d::Constant(60 / std::tan(17.5 * kPi / 180));
  EXPECT_TRUE(IsValidCamera(posed));
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {80, 60}, {150, 17}}) {
    const Ray a = CameraRay(looking, x, y, 160, 120);
    const Ray b = CameraRay(posed, x, y, 160, 120);
    EXPECT_TRUE(a.origin.isApprox(b.origin, kRounding));
    EXPECT_TRUE(a.direction.isApprox(b.direction, kRounding));
  }
}

TEST(Camera, APoseTurnsTheOrthographicOne) {
  Camera camera;
  camera.world_from_camera = Turned(0.7);
  ASSERT_TRUE(IsValidCamera(camera));
  const Ray plain = CameraRay(Camera(), 30, 11, 80, 60);
  const Ray ray = CameraRay(camera, 30, 11, 80, 60);
  const Eigen::Matrix3d turn = camera.world_from_camera->topLeftCorner<3, 3>();
  EXPECT_TRUE(ray.direction.isApprox(turn * plain.direction, kRounding));
  EXPECT_TRUE(ray.origin.isApprox(
      turn * plain.origin + Eigen::Vector3d(0.3, -2, 5), kRounding));
}

TEST(Camera, ACentreOffTheMiddleMovesTheView) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.centre_pixels = Eigen::Vector2d(20, 90);
  EXPECT_TRUE(CameraRay(camera, 20, 90, 160, 120)
                  .direction.isApprox(-Eigen::Vector3d::UnitZ(), kRounding));
  camera.focal_pixels = Eigen::Vector2d(100, 50);
  const Ray ray = CameraRay(camera, 120, 40, 160, 120);
  EXPECT_TRUE(ray.direction.isApprox(Eigen::Vector3d(1, 1, -1).normalized(),
                                     kRounding));
}

TEST(Camera, RefusesLensesAndPosesThatAreNone) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  for (const double focal :
       {0.0, -3.0, std::numeric_limits<double>::infinity()}) {
    camera.focal_pixels = Eigen::Vector2d(5.0, focal);
    EXPECT_FALSE(IsValidCamera(camera)) << focal;
  }
  camera.focal_pixels = Eigen::Vector2d(5.0, 6.0);
  EXPECT_TRUE(IsValidCamera(camera));
  EXPECT_EQ("", PoseFault(Turned(2.0)));
  Eigen::Matrix4d pose = Turned(2.0);
  pose.col(1) *= 1.5;
  EXPECT_EQ("expected a rotation, found axes of lengths 1, 1.5, 1",
            PoseFault(pose));
  camera.world_from_camera = pose;
  EXPECT_FALSE(IsValidCamera(camera));
  pose = Turned(2.0);
  pose.col(0) = pose.col(1);
  EXPECT_EQ("expected a rotation, found axes that are not perpendicular",
            PoseFault(pose));
  pose = Turned(2.0);
  pose.col(2) *= -1.0;
  EXPECT_EQ("expected a rotation, found a mirror image of one",
            PoseFault(pose));
  pose = Turned(2.0);
  pose(3, 0) = 0.01;
  EXPECT_EQ("expected 0, 0, 0, 1 in the last row", PoseFault(pose));
  pose(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ("expected finite numbers", PoseFault(pose));
}

TEST(Camera, RoundedPosesBecomeRotations) {
  const Eigen::Matrix4d exact = Turned(0.4);
  EXPECT_EQ(exact, NearestPose(exact));
  Eigen::Matrix4d rounded = exact;
  rounded.topLeftCorner<3, 3>() =
      (1e3 * exact.topLeftCorner<3, 3>()).array().round() / 1e3;
  ASSERT_EQ("", PoseFault(rounded));
  const Eigen::Matrix4d near = NearestPose(rounded);
  EXPECT_LT((near - exact).cwiseAbs().maxCoeff(), 1e-3);
  const Eigen::Matrix3d r = near.topLeftCorner<3, 3>();
  EXPECT_TRUE((r.transpose() * r).isIdentity(kRounding));
  EXPECT_EQ(near, NearestPose(near));
}

TEST(Camera, NothingIsSeenBehindAPinhole) {
  Camera camera;
  camera.type = CameraType::kPerspective;  // at z = 4, looking along -z
  EXPECT_TRUE(ProjectPoint(camera, {0, 0, 3.9}, 40, 30).has_value());
  EXPECT_FALSE(ProjectPoint(camera, {0, 0, 4.0}, 40, 30).has_value());
  EXPECT_FALSE(ProjectPoint(camera, {0, 0, 5.0}, 40, 30).has_value());
  EXPECT_TRUE(ProjectPoint(Camera(), {0, 0, 5.0}, 40, 30).has_value());
}

}  // namespace
}  // namespace ibrdf
