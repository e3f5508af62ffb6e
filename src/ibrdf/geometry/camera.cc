#include "ibrdf/geometry/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {
// Sine of the smallest angle between view and `up` that still fixes the roll.
constexpr double kMinUpSine = 1e-6;
}  // namespace

bool IsValidCamera(const Camera& camera) {
  if (camera.type == CameraType::kOrthographic) return true;
  if (!camera.from.allFinite() || !camera.to.allFinite() ||
      !camera.up.allFinite() || !(camera.fov_degrees > 0.0) ||
      !(camera.fov_degrees < 180.0)) {
    return false;
  }
  const Eigen::Vector3d view = camera.to - camera.from;
  if (!(view.norm() > 0.0) || !(camera.up.norm() > 0.0)) return false;
  return view.normalized().cross(camera.up.normalized()).norm() > kMinUpSine;
}

Ray CameraRay(const Camera& camera, double x, double y, int width, int height) {
  if (camera.type == CameraType::kOrthographic) {
    const double scale = 2.0 / std::min(width, height);
    return {{(x - 0.5 * width) * scale, (0.5 * height - y) * scale, 0.0},
            {0.0, 0.0, -1.0}};
  }
  const Eigen::Vector3d view = (camera.to - camera.from).normalized();
  const Eigen::Vector3d right = view.cross(camera.up).normalized();
  const Eigen::Vector3d top = right.cross(view);
  const double scale =
      2.0 * std::tan(camera.fov_degrees * (kPi / 360.0)) / height;
  const Eigen::Vector3d d = view + (x - 0.5 * width) * scale * right +
                            (0.5 * height - y) * scale * top;
  return {camera.from, d.normalized()};
}

}  // namespace ibrdf
