#include "ibrdf/solvers/entropy_study/study_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/triangle_mesh.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/solvers/bench/sweep_files.h"

namespace ibrdf {
namespace {

using Eigen::Vector3d;

// Rays start so far from the surface, in units of its radius: smooth normals of
// coarse triangles would else be hidden by their own facets.
constexpr double kRayOffset = 3e-3;

// A torus about y, with normals.
TriangleMesh Torus() {
  constexpr int kAround = 128, kAcross = 64;
  constexpr double kMajor = 0.7, kMinor = 0.3;
  TriangleMesh mesh;
  for (int i = 0; i < kAround; ++i) {
    const double a = 2.0 * kPi * i / kAround;
    const Vector3d out(std::cos(a), 0.0, std::sin(a));
    for (int j = 0; j < kAcross; ++j) {
      const double b = 2.0 * kPi * j / kAcross;
      const Vector3d n = std::cos(b) * out + std::sin(b) * Vector3d::UnitY();
      mesh.vertices.push_back((kMajor * out + kMinor * n).cast<float>());
      mesh.normals.push_back(n.cast<float>());
    }
  }
  const auto at = [](int i, int j) {
    return (i % kAround) * kAcross + j % kAcross;
  };
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

StatusOr<TriangleMesh> MeshOf(const std::string& folder,
                              const std::string& shape) {
  if (shape == "torus") return Torus();
  const std::string path =
      FindFile(folder, shape, {".obj", ".ply", ".stl", ".glb"});
  if (path.empty()) {
    return InvalidInput(
        "command line: --shapes",
        "expected sphere, torus or a mesh of " + folder + ", found " + shape);
  }
  StatusOr<TriangleMesh> mesh = ReadMesh(path);
  if (!mesh.ok()) return mesh.status();
  if (mesh->normals.empty()) ComputeVertexNormals(&*mesh);
  FitUnitSphere(&*mesh);
  return mesh;
}

// Sums of the triangles' areas, up to and with each.
std::vector<double> AreaSums(const TriangleMesh& mesh) {
  std::vector<double> sums;
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]];
    sum += 0.5 * (mesh.vertices[t[1]] - a)
                     .cross(mesh.vertices[t[2]] - a)
                     .cast<double>()
                     .norm();
    sums.push_back(sum);
  }
  return sums;
}

std::vector<SurfacePoint> PointsOf(const TriangleMesh& mesh, int count,
                                   unsigned seed) {
  const std::vector<double> sums = AreaSums(mesh);
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<SurfacePoint> out;
  for (int k = 0; k < count; ++k) {
    const double area = (k + u(rng)) / count * sums.back();
    const auto t = std::min(
        mesh.triangles.size() - 1,
        static_cast<size_t>(std::upper_bound(sums.begin(), sums.end(), area) -
                            sums.begin()));
    // Uniform over the triangle.
    const double root = std::sqrt(u(rng)), part = u(rng);
    const double share[3] = {1.0 - root, root * (1.0 - part), root * part};
    Vector3d position = Vector3d::Zero(), normal = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const int vertex = mesh.triangles[t][i];
      position += share[i] * mesh.vertices[vertex].cast<double>();
      normal += share[i] * mesh.normals[vertex].cast<double>();
    }
    normal.normalize();
    out.push_back({position + kRayOffset * normal, normal});
  }
  return out;
}

}  // namespace

std::vector<Vector3d> FibonacciSphere(int count) {
  std::vector<Vector3d> out;
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count;
    const double phi = k * kPi * (3.0 - std::sqrt(5.0));
    const double s = std::sqrt(1.0 - z * z);
    out.emplace_back(s * std::cos(phi), z, s * std::sin(phi));
  }
  return out;
}

StatusOr<StudySurface> MakeStudySurface(const std::string& folder,
                                        const std::string& shape,
                                        int num_points, unsigned seed) {
  StudySurface out;
  if (shape == "sphere") {
    for (const Vector3d& n : FibonacciSphere(num_points)) {
      out.points.push_back({n, n});
    }
    return out;
  }
  const StatusOr<TriangleMesh> mesh = MeshOf(folder, shape);
  if (!mesh.ok()) return mesh.status();
  StatusOr<Scene> scene = Scene::FromMesh(*mesh);
  if (!scene.ok()) return scene.status();
  out.scene = *std::move(scene);
  out.points = PointsOf(*mesh, num_points, seed);
  return out;
}

}  // namespace ibrdf
