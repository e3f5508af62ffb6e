#include "ibrdf/geometry/up_axis.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(UpAxis, BlendersZIsOurY) {
  const Eigen::Matrix3d turn = YUpFrom(UpAxis::kZ);
  EXPECT_EQ(Eigen::Vector3d(1, 0, 0), turn * Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(Eigen::Vector3d(0, 0, -1), turn * Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(Eigen::Vector3d(0, 1, 0), turn * Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(1.0, turn.determinant());
  EXPECT_TRUE(YUpFrom(UpAxis::kY).isIdentity(0.0));
}

// A turned camera sees a turned point where the first one sees the point, and
// the way back keeps every bit.
TEST(UpAxis, TurnedCamerasSeeTurnedPoints) {
  const Eigen::Matrix3d turn = YUpFrom(UpAxis::kZ);
  Camera placed;
  placed.type = CameraType::kPerspective;
  placed.from = {0.3, -4.0, 1.7};
  placed.to = {0.1, 0.2, -0.3};
  placed.up = {0.0, 0.1, 1.0};
  Camera posed = placed;
  posed.world_from_camera = Eigen::Matrix4d::Identity();
  posed.world_from_camera->topLeftCorner<3, 3>() =
      AxesOf(placed).world_from_camera;
  posed.world_from_camera->topRightCorner<3, 1>() = placed.from;
  const Camera plain;  // orthographic, without a pose
  for (const Camera& camera : {placed, posed, plain}) {
    const Camera turned = Turned(camera, turn);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.5, -0.4, 0.3)}) {
      const auto before = ProjectPoint(camera, point, 80, 60);
      const auto after = ProjectPoint(turned, turn * point, 80, 60);
      ASSERT_TRUE(before.has_value() && after.has_value());
      EXPECT_NEAR(before->x, after->x, 1e-12);
      EXPECT_NEAR(before->y, after->y, 1e-12);
      EXPECT_NEAR(before->depth, after->depth, 1e-12);
    }
    const Camera back = Turned(turned, turn.transpose());
    EXPECT_EQ(camera.from, back.from);
    EXPECT_EQ(AxesOf(camera).world_from_camera, AxesOf(back).world_from_camera);
  }
}

}  // namespace
}  // namespace ibrdf
