// Points of the picture's plane.
#pragma once
#include <Eigen/Core>

namespace ibrdf {

// Twice the area of the triangle 0, a, b; > 0 where it is counterclockwise.
inline double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace ibrdf
