// Colours without their luminance, as points of a plane.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace ibrdf {

// Coordinates of a log colour's chroma: in an orthonormal basis of the log
// colours whose channels sum to 0.
inline Eigen::Array2d ChromaPlane(const Eigen::Array3d& log_colour) {
  return {
      (log_colour[0] - log_colour[2]) / std::sqrt(2.0),
      (log_colour[0] - 2.0 * log_colour[1] + log_colour[2]) / std::sqrt(6.0)};
}

// The log colour of that chroma and no luminance.
inline Eigen::Array3d FromChromaPlane(const Eigen::Array2d& chroma) {
  const double x = chroma[0] / std::sqrt(2.0), y = chroma[1] / std::sqrt(6.0);
  return {x + y, -2.0 * y, y - x};
}

}  // namespace ibrdf
