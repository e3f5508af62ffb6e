// A ball of several materials: each log radiance is a smooth function of the
// normal.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"

namespace ibrdf {

struct LabelledBall {
  int width = 0;
  std::vector<ShadingPoint> points;
  std::vector<int> labels;       // [points]
  std::vector<double> radiance;  // [points * 3]

  Observations Observed() const { return MakeObservations(radiance); }
};

// Matte in one colour, matte in another, and darker with a lamp's gloss.
inline Eigen::Array3d LogRadiance(int material, const Eigen::Vector3d& n) {
  const double lit = std::log(1.2 + n.x() + 0.5 * n.y());
  switch (material) {
    case 0:
      return Eigen::Array3d(-1.0, -1.3, -1.6) + lit;
    case 1:
      return Eigen::Array3d(-1.9, -1.4, -1.2) + lit;
    default:
      return Eigen::Array3d(-2.4, -2.3, -2.2) + 2.5 * n.x() * n.z();
  }
}

// noise: deviation of log radiance. label_at: of column and row.
inline LabelledBall MakeLabelledBall(
    int width, double noise, const std::function<int(int, int)>& label_at) {
  LabelledBall ball;
  ball.width = width;
  std::mt19937 rng(3);
  std::normal_distribution<double> normal(0.0, noise);
  for (int y = 0; y < width; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width * 2.0 - 1.0;
      const double v = 1.0 - (y + 0.5) / width * 2.0;
      if (u * u + v * v > 0.99) continue;
      const Eigen::Vector3d n(u, v, std::sqrt(1.0 - u * u - v * v));
      ShadingPoint point;
      point.normal = n.cast<float>();
      point.wo = Eigen::Vector3f::UnitZ();
      point.pixel = y * width + x;
      point.coverage = 1.0f;
      ball.points.push_back(point);
      ball.labels.push_back(label_at(x, y));
      const Eigen::Array3d log = LogRadiance(ball.labels.back(), n);
      for (int c = 0; c < 3; ++c) {
        ball.radiance.push_back(std::exp(log[c] + normal(rng)));
      }
    }
  }
  return ball;
}

}  // namespace ibrdf
