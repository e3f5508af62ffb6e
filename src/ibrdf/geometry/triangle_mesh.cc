#include "ibrdf/geometry/triangle_mesh.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ibrdf {

void ComputeVertexNormals(TriangleMesh* mesh) {
  // Twice the area against the longest squared edge: below this the direction
  // of the normal is rounding of the float coordinates.
  constexpr double kMinRelativeArea = 1e-10;
  const size_t count = mesh->vertices.size();
  std::vector<Eigen::Vector3d> sums(count, Eigen::Vector3d::Zero());
  for (const std::array<int, 3>& triangle : mesh->triangles) {
    Eigen::Vector3d p[3];
    for (size_t i = 0; i < 3; ++i) {
      CHECK_GE(triangle[i], 0);
      CHECK_LT(static_cast<size_t>(triangle[i]), count);
      p[i] = mesh->vertices[triangle[i]].cast<double>();
    }
    const Eigen::Vector3d cross = (p[1] - p[0]).cross(p[2] - p[0]);
    const double twice_area = cross.norm();
    const double longest =
        std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(),
                  (p[0] - p[2]).squaredNorm()});
    if (!(twice_area > kMinRelativeArea * longest)) continue;
    const Eigen::Vector3d normal = cross / twice_area;
    for (size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d a = p[(i + 1) % 3] - p[i];
      const Eigen::Vector3d b = p[(i + 2) % 3] - p[i];
      sums[triangle[i]] += std::atan2(twice_area, a.dot(b)) * normal;
    }
  }
  mesh->normals.resize(count);
  for (size_t v = 0; v < count; ++v) {
    const double length = sums[v].norm();
    // Opposite faces cancel to rounding.
    mesh->normals[v] = length > 1e-12
                           ? Eigen::Vector3f((sums[v] / length).cast<float>())
                           : Eigen::Vector3f::UnitZ();
  }
}

std::vector<int> NormalsAgainstFaces(const TriangleMesh& mesh) {
  CHECK_EQ(mesh.normals.size(), mesh.vertices.size());
  // Cosine of normal and face of the same side, the least.
  constexpr double kAgrees = 0.1;
  // With this share of corners on one side of their faces the winding means
  // something.
  constexpr double kOneWinding = 0.9;
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<double> least(mesh.vertices.size(), inf);
  std::vector<double> most(mesh.vertices.size(), -inf);
  size_t front = 0, back = 0;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    Eigen::Vector3d p[3];
    for (size_t i = 0; i < 3; ++i) {
      p[i] = mesh.vertices[triangle[i]].cast<double>();
    }
    const Eigen::Vector3d cross = (p[1] - p[0]).cross(p[2] - p[0]);
    if (!(cross.stableNorm() > 0.0)) continue;
    const Eigen::Vector3d face = cross.stableNormalized();
    for (const int v : triangle) {
      const double cosine = face.dot(mesh.normals[v].cast<double>());
      front += cosine > kAgrees;
      back += cosine < -kAgrees;
      least[v] = std::min(least[v], cosine);
      most[v] = std::max(most[v], cosine);
    }
  }
  const double sides = static_cast<double>(front + back);
  const bool outward = static_cast<double>(front) >= kOneWinding * sides;
  const bool inward = static_cast<double>(back) >= kOneWinding * sides;
  std::vector<int> against;
  for (size_t v = 0; v < least.size(); ++v) {
    if (least[v] > most[v]) continue;
    const double agreement = outward  ? most[v]
                             : inward ? -least[v]
                                      : std::max(most[v], -least[v]);
    if (agreement < kAgrees) against.push_back(static_cast<int>(v));
  }
  return against;
}

BoundingSphere FitUnitSphere(TriangleMesh* mesh) {
  if (mesh->vertices.empty()) return {};
  Eigen::Vector3d low = mesh->vertices[0].cast<double>(), high = low;
  for (const Eigen::Vector3f& v : mesh->vertices) {
    low = low.cwiseMin(v.cast<double>());
    high = high.cwiseMax(v.cast<double>());
  }
  const Eigen::Vector3d centre = 0.5 * (low + high);
  double radius = 0.0;
  for (const Eigen::Vector3f& v : mesh->vertices) {
    radius = std::max(radius, (v.cast<double>() - centre).norm());
  }
  const double scale = radius > 0.0 ? 1.0 / radius : 1.0;
  for (Eigen::Vector3f& v : mesh->vertices) {
    v = ((v.cast<double>() - centre) * scale).cast<float>();
  }
  return {centre, radius};
}

}  // namespace ibrdf
