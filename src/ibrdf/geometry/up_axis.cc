#include "ibrdf/geometry/up_axis.h"

namespace ibrdf {

Eigen::Matrix3d YUpFrom(UpAxis up) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (up == UpAxis::kZ) rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return rotation;
}

Eigen::Matrix4d Turned(const Eigen::Matrix4d& world_from_camera,
                       const Eigen::Matrix3d& rotation) {
  Eigen::Matrix4d out = world_from_camera;
  out.topRows<3>() = rotation * world_from_camera.topRows<3>();
  return out;
}

Camera Turned(const Camera& camera, const Eigen::Matrix3d& rotation) {
  Camera out = camera;
  if (rotation.isIdentity(0.0)) return out;
  if (camera.world_from_camera) {
    out.world_from_camera = Turned(*camera.world_from_camera, rotation);
  } else if (camera.type == CameraType::kOrthographic) {
    out.world_from_camera =
        Turned(Eigen::Matrix4d(Eigen::Matrix4d::Identity()), rotation);
  } else {
    out.from = rotation * camera.from;
    out.to = rotation * camera.to;
    out.up = rotation * camera.up;
  }
  return out;
}

}  // namespace ibrdf
