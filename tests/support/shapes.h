// Meshes whose area and points are known.
#pragma once
#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/triangle_mesh.h"

namespace ibrdf {

// A torus about y without texture coordinates: around x across quads, cut in
// two, with normals.
inline TriangleMesh TorusMesh(int around, int across, double major = 1.0,
                              double minor = 0.4) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    const double a = 2.0 * kPi * i / around;
    for (int j = 0; j < across; ++j) {
      const double b = 2.0 * kPi * j / across;
      const Eigen::Vector3d out(std::cos(a), 0.0, std::sin(a));
      const Eigen::Vector3d n =
          std::cos(b) * out + std::sin(b) * Eigen::Vector3d::UnitY();
      mesh.vertices.push_back((major * out + minor * n).cast<float>());
      mesh.normals.push_back(n.cast<float>());
    }
  }
  const auto at = [&](int i, int j) {
    return (i % around) * across + j % across;
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

inline double AreaOfTriangle(const TriangleMesh& mesh, size_t t) {
  Eigen::Vector3d p[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = mesh.vertices[mesh.triangles[t][k]].cast<double>();
  }
  return 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
}

inline double AreaOf(const TriangleMesh& mesh) {
  double area = 0.0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    area += AreaOfTriangle(mesh, t);
  }
  return area;
}

// A staircase that winds twice about y: seen from above it overlaps itself.
inline TriangleMesh WindingRamp(int steps) {
  TriangleMesh mesh;
  for (int i = 0; i <= steps; ++i) {
    const double a = 4.0 * kPi * i / steps;
    for (const double r : {0.3, 1.0}) {
      mesh.vertices.emplace_back(
          Eigen::Vector3d(r * std::cos(a), 0.05 * a, -r * std::sin(a))
              .cast<float>());
    }
  }
  for (int i = 0; i < steps; ++i) {
    const int v = 2 * i;
    mesh.triangles.push_back({v, v + 1, v + 3});
    mesh.triangles.push_back({v, v + 3, v + 2});
  }
  return mesh;
}

}  // namespace ibrdf
