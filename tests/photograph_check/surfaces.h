// Normals of analytic surfaces, and images on them.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// Normals [size x size] of the unit sphere from edge to edge; zero outside.
inline Image SphereNormals(int size) {
  Image normals(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double u = 2.2 * (x + 0.5) / size - 1.1;
      const double v = 1.1 - 2.2 * (y + 0.5) / size;
      if (u * u + v * v >= 1.0) continue;
      float* const n = normals.At(x, y);
      n[0] = static_cast<float>(u);
      n[1] = static_cast<float>(v);
      n[2] = static_cast<float>(std::sqrt(1.0 - u * u - v * v));
    }
  }
  return normals;
}

// Normals of z = height(u, v) over the whole image, u right and v up in
// [-1, 1], by differences.
inline Image SurfaceNormals(
    int size, const std::function<double(double, double)>& height) {
  constexpr double kStep = 1e-4;
  Image normals(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double u = 2.0 * (x + 0.5) / size - 1.0;
      const double v = 1.0 - 2.0 * (y + 0.5) / size;
      const Eigen::Vector3d n =
          Eigen::Vector3d(height(u - kStep, v) - height(u + kStep, v),
                          height(u, v - kStep) - height(u, v + kStep),
                          2.0 * kStep)
              .normalized();
      for (int c = 0; c < 3; ++c)
        normals.At(x, y)[c] = static_cast<float>(n[c]);
    }
  }
  return normals;
}

// Points of the set normals, seen along -z.
inline std::vector<ShadingPoint> PointsOf(const Image& normals) {
  std::vector<ShadingPoint> points;
  for (size_t i = 0; i < normals.num_pixels(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> n(&normals.rgb[3 * i]);
    if (n.isZero()) continue;
    ShadingPoint point{};
    point.normal = n;
    point.wo = Eigen::Vector3f::UnitZ();
    point.pixel = static_cast<int>(i);
    points.push_back(point);
  }
  return points;
}

// Radiance of each set normal, at pixel (x, y).
inline Image Painted(const Image& normals,
                     const std::function<Eigen::Array3d(const Eigen::Vector3d&,
                                                        int, int)>& radiance) {
  Image image(normals.width, normals.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Eigen::Map<const Eigen::Vector3f> n(normals.At(x, y));
      if (n.isZero()) continue;
      const Eigen::Array3d L = radiance(n.cast<double>(), x, y);
      for (int c = 0; c < 3; ++c) image.At(x, y)[c] = static_cast<float>(L[c]);
    }
  }
  return image;
}

// A surface of many bumps, on which normals come back at other places.
inline double Bumps(double u, double v) {
  return 0.15 * std::sin(7.0 * u) * std::cos(6.0 * v) + 0.05 * std::sin(11 * v);
}

}  // namespace ibrdf
