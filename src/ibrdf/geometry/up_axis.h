// Worlds of other programs, whose up axis is another one.
#pragma once
#include <Eigen/Core>

#include "ibrdf/geometry/camera.h"

namespace ibrdf {

// kZ: Blender's, whose X, Y and Z are our x, -z and y.
enum class UpAxis { kY, kZ };

// The rotation from such a world to the library's, where y is up. Its entries
// are 0, 1 and -1: what it turns keeps its bits.
Eigen::Matrix3d YUpFrom(UpAxis up);

// A camera in the world that `rotation` leads to. An orthographic one without a
// pose gets one, unless the rotation is none.
Camera Turned(const Camera& camera, const Eigen::Matrix3d& rotation);
Eigen::Matrix4d Turned(const Eigen::Matrix4d& world_from_camera,
                       const Eigen::Matrix3d& rotation);

}  // namespace ibrdf
