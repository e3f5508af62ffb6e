#include "ibrdf/geometry/camera.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// Sine of the smallest angle between view and `up` that still fixes the roll.
constexpr double kMinUpSine = 1e-6;
// Files have three digits of a rotation or more.
constexpr double kMaxPoseRounding = 2e-3;
constexpr double kExactPose = 1e-12;

// Largest entry of R^T R - 1.
double Skew(const Eigen::Matrix3d& rotation) {
  return (rotation.transpose() * rotation - Eigen::Matrix3d::Identity())
      .cwiseAbs()
      .maxCoeff();
}

bool LooksSomewhere(const Camera& camera) {
  if (!camera.from.allFinite() || !camera.to.allFinite() ||
      !camera.up.allFinite()) {
    return false;
  }
  const Eigen::Vector3d view = camera.to - camera.from;
  if (!(view.norm() > 0.0) || !(camera.up.norm() > 0.0)) return false;
  return view.normalized().cross(camera.up.normalized()).norm() > kMinUpSine;
}

bool HasValidLens(const Camera& camera) {
  if (camera.centre_pixels && !camera.centre_pixels->allFinite()) return false;
  if (camera.focal_pixels) {
    return camera.focal_pixels->allFinite() &&
           camera.focal_pixels->minCoeff() > 0.0;
  }
  return camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0;
}

}  // namespace

std::string PoseFault(const Eigen::Matrix4d& world_from_camera) {
  if (!world_from_camera.allFinite()) return "expected finite numbers";
  const Eigen::RowVector4d last = world_from_camera.row(3);
  if ((last - Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)).cwiseAbs().maxCoeff() >
      kExactPose) {
    return "expected 0, 0, 0, 1 in the last row";
  }
  const Eigen::Matrix3d rotation = world_from_camera.topLeftCorner<3, 3>();
  const Eigen::RowVector3d lengths = rotation.colwise().norm();
  if (!((lengths.array() - 1.0).abs().maxCoeff() < kMaxPoseRounding)) {
    return "expected a rotation, found axes of lengths " +
           Format("%.4g", lengths[0]) + ", " + Format("%.4g", lengths[1]) +
           ", " + Format("%.4g", lengths[2]);
  }
  if (!(Skew(rotation) < kMaxPoseRounding)) {
    return "expected a rotation, found axes that are not perpendicular";
  }
  if (rotation.determinant() < 0.0) {
    return "expected a rotation, found a mirror image of one";
  }
  return "";
}

Eigen::Matrix4d NearestPose(const Eigen::Matrix4d& world_from_camera) {
  Eigen::Matrix4d pose = world_from_camera;
  const Eigen::Matrix3d rotation = pose.topLeftCorner<3, 3>();
  if (Skew(rotation) < kExactPose) return pose;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  pose.topLeftCorner<3, 3>() = svd.matrixU() * svd.matrixV().transpose();
  return pose;
}

bool IsValidCamera(const Camera& camera) {
  if (camera.world_from_camera &&
      !PoseFault(*camera.world_from_camera).empty()) {
    return false;
  }
  if (camera.type == CameraType::kOrthographic) return true;
  return HasValidLens(camera) &&
         (camera.world_from_camera || LooksSomewhere(camera));
}

CameraAxes AxesOf(const Camera& camera) {
  CameraAxes axes;
  if (camera.world_from_camera) {
    axes.world_from_camera = camera.world_from_camera->topLeftCorner<3, 3>();
    axes.centre = camera.world_from_camera->topRightCorner<3, 1>();
  } else if (camera.type == CameraType::kPerspective) {
    const Eigen::Vector3d view = (camera.to - camera.from).normalized();
    const Eigen::Vector3d right = view.cross(camera.up).normalized();
    axes.world_from_camera << right, right.cross(view), -view;
    axes.centre = camera.from;
  }
  return axes;
}

PixelGrid PixelGridOf(const Camera& camera, int width, int height) {
  const Eigen::Vector2d middle(0.5 * width, 0.5 * height);
  if (camera.type == CameraType::kOrthographic) {
    return {middle, Eigen::Vector2d::Constant(2.0 / std::min(width, height))};
  }
  PixelGrid grid;
  grid.centre = camera.centre_pixels.value_or(middle);
  if (camera.focal_pixels) {
    grid.side = camera.focal_pixels->cwiseInverse();
  } else {
    grid.side.setConstant(2.0 * std::tan(camera.fov_degrees * (kPi / 360.0)) /
                          height);
  }
  return grid;
}

Ray CameraRay(const Camera& camera, double x, double y, int width, int height) {
  const PixelGrid grid = PixelGridOf(camera, width, height);
  const double right = (x - grid.centre.x()) * grid.side.x();
  const double up = (grid.centre.y() - y) * grid.side.y();
  if (camera.type == CameraType::kOrthographic && !camera.world_from_camera) {
    return {{right, up, 0.0}, {0.0, 0.0, -1.0}};
  }
  const CameraAxes axes = AxesOf(camera);
  const Eigen::Matrix3d& a = axes.world_from_camera;
  if (camera.type == CameraType::kOrthographic) {
    return {axes.centre + right * a.col(0) + up * a.col(1), -a.col(2)};
  }
  const Eigen::Vector3d d = -a.col(2) + right * a.col(0) + up * a.col(1);
  return {axes.centre, d.normalized()};
}

std::optional<ImagePoint> ProjectPoint(const Camera& camera,
                                       const Eigen::Vector3d& point, int width,
                                       int height) {
  const CameraAxes axes = AxesOf(camera);
  const Eigen::Vector3d local =
      axes.world_from_camera.transpose() * (point - axes.centre);
  const bool perspective = camera.type == CameraType::kPerspective;
  const double depth = -local.z();
  if (perspective && !(depth > 0.0)) return std::nullopt;
  const PixelGrid grid = PixelGridOf(camera, width, height);
  const double scale = perspective ? depth : 1.0;
  return ImagePoint{grid.centre.x() + local.x() / (scale * grid.side.x()),
                    grid.centre.y() - local.y() / (scale * grid.side.y()),
                    depth};
}

}  // namespace ibrdf
