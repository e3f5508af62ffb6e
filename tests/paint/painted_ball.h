// A ball in four paints under a coloured lamp in an evenly lit room.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/paint/shading_light.h"

namespace ibrdf {

inline constexpr int kBallWidth = 96;

struct PaintedBall {
  std::vector<ShadingPoint> points;
  std::vector<double> log_albedo, radiance;  // [points * 3]
};

inline Eigen::Array3d PaintAt(int x, int y) {
  const Eigen::Array3d paints[] = {{0.1, 0.0, -0.2},
                                   {-0.2, -1.2, -1.4},
                                   {-1.6, -1.0, -0.3},
                                   {-1.1, -0.3, -1}};
  return paints[(x / 11 + 3 * (y / 17)) % 4];
}

inline PaintedBall MakePaintedBall(const ShadingLight& light) {
  PaintedBall ball;
  for (int y = 0; y < kBallWidth; ++y) {
    for (int x = 0; x < kBallWidth; ++x) {
      const double u = (x + 0.5) / kBallWidth * 2.0 - 1.0;
      const double v = 1.0 - (y + 0.5) / kBallWidth * 2.0;
      if (u * u + v * v > 0.96) continue;
      ShadingPoint point;
      point.normal =
          Eigen::Vector3d(u, v, std::sqrt(1.0 - u * u - v * v)).cast<float>();
      point.wo = Eigen::Vector3f::UnitZ();
      point.pixel = y * kBallWidth + x;
      point.coverage = 1.0f;
      ball.points.push_back(point);
      const Eigen::Array3d a = PaintAt(x, y);
      const Eigen::Array3d radiance =
          a.exp() * Irradiance(light, point.normal.cast<double>());
      for (int c = 0; c < 3; ++c) {
        ball.log_albedo.push_back(a[c]);
        ball.radiance.push_back(radiance[c]);
      }
    }
  }
  return ball;
}

// Deviation of a - b, each channel about its mean.
inline double AlignedRmse(const std::vector<double>& a,
                          const std::vector<double>& b) {
  const auto n = static_cast<Eigen::Index>(a.size() / 3);
  Eigen::Matrix3Xd d = Eigen::Map<const Eigen::Matrix3Xd>(a.data(), 3, n) -
                       Eigen::Map<const Eigen::Matrix3Xd>(b.data(), 3, n);
  const Eigen::Vector3d mean = d.rowwise().mean();
  d.colwise() -= mean;
  return std::sqrt(d.squaredNorm() / static_cast<double>(d.size()));
}

}  // namespace ibrdf
