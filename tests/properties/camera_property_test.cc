// What is seen at a position of the image projects back to it.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>

#include "ibrdf/geometry/camera.h"
#include "tests/properties/generators.h"

namespace ibrdf {
namespace {

Eigen::Vector3d AnyPoint(double size) {
  return {*Between(-size, size), *Between(-size, size), *Between(-size, size)};
}

Eigen::Matrix4d AnyPose() {
  Eigen::Vector4d q(*Between(-1, 1), *Between(-1, 1), *Between(-1, 1),
                    *Between(-1, 1));
  if (q.norm() < 0.1) q = {1, 0, 0, 0};
  q.normalize();
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topLeftCorner<3, 3>() =
      Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  pose.topRightCorner<3, 1>() = AnyPoint(10.0);
  return pose;
}

Camera AnyCamera(int width, int height) {
  Camera camera;
  camera.type =
      *rc::gen::element(CameraType::kOrthographic, CameraType::kPerspective);
  if (*Choice(2) == 0) {
    camera.world_from_camera = AnyPose();
  } else {
    camera.from = AnyPoint(5.0) + Eigen::Vector3d(0.0, 0.0, 8.0);
  }
  if (*Choice(2) == 0) {
    camera.focal_pixels = Eigen::Vector2d(*Magnitude(0.3, 5.0) * width,
                                          *Magnitude(0.3, 5.0) * width);
  } else {
    camera.fov_degrees = *Between(1.0, 150.0);
  }
  if (*Choice(2) == 0) {
    camera.centre_pixels =
        Eigen::Vector2d(*Between(-1, 2) * width, *Between(-1, 2) * height);
  }
  return camera;
}

RC_GTEST_PROP(CameraProperty, ProjectPointInvertsCameraRay, ()) {
  const int width = *rc::gen::inRange(1, 2000);
  const int height = *rc::gen::inRange(1, 2000);
  const Camera camera = AnyCamera(width, height);
  RC_PRE(IsValidCamera(camera));
  const double x = *Unit() * width, y = *Unit() * height;
  const double distance = *Magnitude(1e-2, 1e3);
  const Ray ray = CameraRay(camera, x, y, width, height);
  const auto p = ProjectPoint(camera, ray.origin + distance * ray.direction,
                              width, height);
  RC_ASSERT(p.has_value());
  // Rounding of the point's coordinates, of size up to 1e3, at its depth.
  const double rounding =
      1e-13 * (10.0 + distance) / p->depth *
      (camera.type == CameraType::kPerspective
           ? PixelGridOf(camera, width, height).side.cwiseInverse().maxCoeff()
           : 1e4);
  RC_ASSERT(std::abs(p->x - x) < 1e-9 + rounding);
  RC_ASSERT(std::abs(p->y - y) < 1e-9 + rounding);
  const double cosine =
      -ray.direction.dot(AxesOf(camera).world_from_camera.col(2));
  RC_ASSERT(std::abs(p->depth - distance * cosine) < 1e-11 * (1 + distance));
}

}  // namespace
}  // namespace ibrdf
