// Rays of the camera.
#pragma once
#include <Eigen/Core>

namespace ibrdf {

enum class CameraType { kOrthographic, kPerspective };

// World frame: right-handed, y up. The orthographic camera looks along -z; the
// shorter side of the image spans [-1, 1], the longer one proportionally more,
// both centred. The perspective fields are not read for it.
struct Camera {
  CameraType type = CameraType::kOrthographic;
  double fov_degrees = 30.0;            // full vertical angle, (0, 180)
  Eigen::Vector3d from{0.0, 0.0, 4.0};  // differs from `to`
  Eigen::Vector3d to{0.0, 0.0, 0.0};
  Eigen::Vector3d up{0.0, 1.0, 0.0};  // not parallel to the view
};

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  // unit
};

// Whether the fields describe a camera: finite, fov in (0, 180), `from` apart
// from `to`, `up` not parallel to the view.
bool IsValidCamera(const Camera& camera);

// Ray through a continuous image position: x in [0, width] from the left edge,
// y in [0, height] from the top edge (pixel centres at +1/2). Orthographic rays
// start at z = 0; whoever traces them moves the start in front of the scene.
Ray CameraRay(const Camera& camera, double x, double y, int width, int height);

}  // namespace ibrdf
