// Meshes that shadow themselves or must not.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "ibrdf/geometry/camera.h"
#include "ibrdf/geometry/triangle_mesh.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace testing {

inline void AddQuad(const std::vector<Eigen::Vector3d>& corners,
                    TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (const Eigen::Vector3d& p : corners) {
    mesh->vertices.push_back(p.cast<float>());
  }
  mesh->triangles.push_back({first, first + 1, first + 2});
  mesh->triangles.push_back({first, first + 2, first + 3});
}

// The closed cube of sides of 2 around the origin.
inline TriangleMesh CubeMesh() {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector3d n = Eigen::Vector3d::Zero(), a = n, b = n;
      n[axis] = side;
      a[(axis + 1) % 3] = 1.0;
      b[(axis + 2) % 3] = side;
      AddQuad({n - a - b, n + a - b, n + a + b, n - a + b}, &mesh);
    }
  }
  return mesh;
}

// Facing z.
inline void AddDisc(const Eigen::Vector3d& centre, double radius, int sides,
                    TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  mesh->vertices.push_back(centre.cast<float>());
  for (int k = 0; k < sides; ++k) {
    const double phi = 2 * kPi * k / sides;
    mesh->vertices.push_back(
        (centre + radius * Eigen::Vector3d(std::cos(phi), std::sin(phi), 0))
            .cast<float>());
    mesh->triangles.push_back(
        {first, first + 1 + k, first + 1 + (k + 1) % sides});
  }
}

// Smooth normals on a grid of a closed surface of two angles.
template <typename Surface>
TriangleMesh GridMesh(int rows, int columns, bool rows_wrap,
                      const Surface& surface) {
  TriangleMesh mesh;
  const int vertex_rows = rows_wrap ? rows : rows + 1;
  for (int r = 0; r < vertex_rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      Eigen::Vector3d p, n;
      surface(static_cast<double>(r) / rows, static_cast<double>(c) / columns,
              &p, &n);
      mesh.vertices.push_back(p.cast<float>());
      mesh.normals.push_back(n.cast<float>());
    }
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int a = r * columns + c, b = r * columns + (c + 1) % columns;
      const int below = (r + 1) % vertex_rows * columns;
      const int d = below + c, e = below + (c + 1) % columns;
      mesh.triangles.push_back({a, d, e});
      mesh.triangles.push_back({a, e, b});
    }
  }
  return mesh;
}

inline TriangleMesh BallMesh(int rings, double radius) {
  return GridMesh(
      rings, 2 * rings, false,
      [radius](double u, double v, Eigen::Vector3d* p, Eigen::Vector3d* n) {
        const double s = std::sin(kPi * u), phi = 2 * kPi * v;
        *n = {s * std::sin(phi), std::cos(kPi * u), s * std::cos(phi)};
        *p = radius * *n;
      });
}

// Radii 0.7 and 0.3 about the y axis.
inline TriangleMesh UnitTorusMesh(int around, int tube) {
  return GridMesh(
      tube, around, true,
      [](double u, double v, Eigen::Vector3d* p, Eigen::Vector3d* n) {
        const double a = 2 * kPi * u, phi = 2 * kPi * v;
        const Eigen::Vector3d out(std::sin(phi), 0, std::cos(phi));
        *n = std::cos(a) * out + std::sin(a) * Eigen::Vector3d::UnitY();
        *p = 0.7 * out + 0.3 * *n;
      });
}

// Looks into the hole from above.
inline Camera TorusCamera() {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.from = {0.5, 4.0, 3.0};
  return camera;
}

// The inside of a unit sphere that is open within `degrees` of the y axis.
inline TriangleMesh BowlMesh(double degrees) {
  const double opening = degrees * kPi / 180;
  return GridMesh(
      64, 128, false,
      [opening](double u, double v, Eigen::Vector3d* p, Eigen::Vector3d* n) {
        const double theta = opening + u * (kPi - opening);
        const double phi = 2 * kPi * v, s = std::sin(theta);
        *p = {s * std::sin(phi), std::cos(theta), s * std::cos(phi)};
        *n = -*p;
      });
}

// BruteForceRadiance with a ray for every direction, and so many bounces; the
// rings of half-vectors widen with the given power.
inline Eigen::Array3d BruteForceShadowed(const Scene& scene,
                                         const ShadingPoint& point,
                                         const BrdfFunction& brdf,
                                         const Image& map, int bounces,
                                         int rings, int samples, int power) {
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  const Eigen::Vector3d t = n.unitOrthogonal(), b = n.cross(t);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  const auto edge = [rings, power](int i) {
    return std::pow(static_cast<double>(i) / rings, power) * kPi / 2;
  };
  for (int i = 0; i < rings; ++i) {
    const double theta = 0.5 * (edge(i) + edge(i + 1));
    const double solid_angle =
        (std::cos(edge(i)) - std::cos(edge(i + 1))) * 2 * kPi / samples;
    for (int k = 0; k < samples; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / samples;
      const Eigen::Vector3d h =
          std::sin(theta) * (std::cos(phi) * t + std::sin(phi) * b) +
          std::cos(theta) * n;
      const double oh = h.dot(wo);
      const Eigen::Vector3d wi = 2 * oh * h - wo;
      if (oh <= 0 || n.dot(wi) <= 0) continue;
      Eigen::Array3d light;
      SurfaceHit hit;
      if (!scene.Occluded(point.position, wi)) {
        light = LookUpMap(map, wi);
      } else if (bounces > 0 &&
                 scene.Intersect({point.position, wi}, false, &hit)) {
        ShadingPoint patch{};
        patch.normal = hit.normal.cast<float>();
        patch.wo = -wi.cast<float>();
        patch.position = hit.position;
        light = BruteForceShadowed(scene, patch, brdf, map, bounces - 1, rings,
                                   samples, power);
      } else {
        continue;
      }
      const HalfDiff a = ToHalfDiff({wi.dot(t), wi.dot(b), wi.dot(n)},
                                    {wo.dot(t), wo.dot(b), wo.dot(n)});
      sum += 4 * oh * n.dot(wi) * solid_angle *
             brdf(a.theta_h, a.theta_d, a.phi_d) * light;
    }
  }
  return sum;
}

}  // namespace testing
}  // namespace ibrdf
