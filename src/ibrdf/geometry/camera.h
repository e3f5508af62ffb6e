// Rays of the camera.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

namespace ibrdf {

enum class CameraType { kOrthographic, kPerspective };

// World frame: right-handed, y up. The orthographic camera looks along -z; the
// shorter side of the image spans [-1, 1], the longer one proportionally more,
// both centred. Of the fields below it reads the pose alone.
struct Camera {
  CameraType type = CameraType::kOrthographic;
  double fov_degrees = 30.0;            // full vertical angle, (0, 180)
  Eigen::Vector3d from{0.0, 0.0, 4.0};  // differs from `to`
  Eigen::Vector3d to{0.0, 0.0, 0.0};
  Eigen::Vector3d up{0.0, 1.0, 0.0};  // not parallel to the view
  // The pose, in place of from, to and up: a rotation whose columns are the
  // camera's axes in the world, right, up and against the view (OpenGL's
  // frame), and the camera's centre. Set: also of the orthographic camera,
  // whose image is centred there.
  std::optional<Eigen::Matrix4d> world_from_camera;
  // In place of fov_degrees: the focal length along x and y, > 0.
  std::optional<Eigen::Vector2d> focal_pixels;
  // Where the view meets the image, from its top left corner, x right and y
  // down; the first pixel's centre is (0.5, 0.5). Unset: the middle.
  std::optional<Eigen::Vector2d> centre_pixels;
};

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  // unit
};

// Whether the fields describe a camera: finite, fov in (0, 180), `from` apart
// from `to`, `up` not parallel to the view; a pose without PoseFault, focal
// lengths > 0.
bool IsValidCamera(const Camera& camera);

// What keeps a matrix from being a pose, as "expected a rotation, found a
// mirror image"; empty where it is one but for the rounding of files.
std::string PoseFault(const Eigen::Matrix4d& world_from_camera);
// The pose nearest to one that is rounded; one that is exact to 1e-12 as it is.
Eigen::Matrix4d NearestPose(const Eigen::Matrix4d& world_from_camera);

struct CameraAxes {
  // Columns: right, up and against the view, in the world. A rotation.
  Eigen::Matrix3d world_from_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};
CameraAxes AxesOf(const Camera& camera);

// Where the view meets the image, in pixels, and the sides of a pixel: at depth
// 1 before the perspective camera, anywhere before the orthographic one.
struct PixelGrid {
  Eigen::Vector2d centre;
  Eigen::Vector2d side;
};
PixelGrid PixelGridOf(const Camera& camera, int width, int height);

// Ray through a continuous image position: x in [0, width] from the left edge,
// y in [0, height] from the top edge (pixel centres at +1/2). Orthographic rays
// start in the plane of the camera's centre, at z = 0 without a pose; whoever
// traces them moves the start in front of the scene.
Ray CameraRay(const Camera& camera, double x, double y, int width, int height);

struct ImagePoint {
  double x, y;   // as CameraRay
  double depth;  // along the view from the camera's centre
};
// The position whose ray passes through `point`, inside of the image or not.
// None behind a perspective camera.
std::optional<ImagePoint> ProjectPoint(const Camera& camera,
                                       const Eigen::Vector3d& point, int width,
                                       int height);

}  // namespace ibrdf
