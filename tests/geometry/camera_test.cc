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

}  // namespace
}  // namespace ibrdf
