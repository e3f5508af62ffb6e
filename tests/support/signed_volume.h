// The volume that a mesh encloses.
#pragma once
#include "ibrdf/geometry/triangle_mesh.h"

namespace ibrdf {

// The volume of a closed mesh; negative where its triangles face inwards.
inline double SignedVolume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

}  // namespace ibrdf
