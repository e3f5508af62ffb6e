#include "solvers/marginal/light_process.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

Eigen::Matrix3d GreyAndChroma(double grey, double chroma) {
  return grey * Eigen::Matrix3d::Ones() +
         chroma * (Eigen::Matrix3d::Identity() -
                   Eigen::Matrix3d::Constant(1.0 / 3.0));
}

}  // namespace

double LightProcess::VarianceWithin(double degrees) const {
  // The mean distance of two points in a unit square is 0.52.
  return (luminance_variance + chroma_variance * 2.0 / 3.0) *
         (1.0 - std::exp(-0.52 * degrees / correlation_degrees));
}

Eigen::Matrix3d LightProcess::Local() const {
  return GreyAndChroma(luminance_variance, chroma_variance);
}

Eigen::Matrix3d LightProcess::Level() const {
  return GreyAndChroma(level_variance, level_chroma_variance);
}

Eigen::Matrix3d ColourAxes() {
  Eigen::Matrix3d axes;
  axes << 1 / std::sqrt(3.0), 1 / std::sqrt(3.0), 1 / std::sqrt(3.0),  //
      1 / std::sqrt(2.0), -1 / std::sqrt(2.0), 0.0,                    //
      1 / std::sqrt(6.0), 1 / std::sqrt(6.0), -2 / std::sqrt(6.0);
  return axes;
}

double LightCorrelation(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        double correlation_degrees) {
  const double scale = 180.0 / (3.14159265358979323846 * correlation_degrees);
  return std::exp(-std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * scale);
}

RowMatrix LightCorrelation(int map_height, int map_width,
                           double correlation_degrees) {
  std::vector<Eigen::Vector3d> directions;
  for (int r = 0; r < map_height; ++r) {
    for (int c = 0; c < map_width; ++c) {
      directions.push_back(
          MapDirection(r + 0.5, c + 0.5, map_height, map_width));
    }
  }
  const auto n = static_cast<Eigen::Index>(directions.size());
  RowMatrix correlation(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      // Rounding would leave a texel a little apart from itself.
      correlation(i, j) = correlation(j, i) =
          i == j ? 1.0
                 : LightCorrelation(directions[i], directions[j],
                                    correlation_degrees);
    }
  }
  return correlation;
}

}  // namespace ibrdf
