// Directions by their angles.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace ibrdf {

// theta from +z, phi from +x to +y; radians.
inline Eigen::Vector3d Direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
          std::cos(theta)};
}

}  // namespace ibrdf
