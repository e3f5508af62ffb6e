#include "ibrdf/geometry/triangle_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ibrdf {
namespace {

// Rounding of a float unit vector.
constexpr float kUnitTolerance = 1e-6f;

// A latitude-longitude sphere with single poles, counter-clockwise outside.
TriangleMesh Sphere(int rows, int columns, const Eigen::Vector3f& centre,
                    float radius) {
  constexpr float kPi = 3.14159265f;
  TriangleMesh mesh;
  const auto add = [&](float theta, float phi) {
    mesh.vertices.push_back(
        centre + radius * Eigen::Vector3f(std::sin(theta) * std::sin(phi),
                                          std::cos(theta),
                                          std::sin(theta) * std::cos(phi)));
  };
  add(0.0f, 0.0f);
  for (int r = 1; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      add(kPi * r / rows, 2.0f * kPi * c / columns);
    }
  }
  add(kPi, 0.0f);
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int r, int c) {
    return 1 + (r - 1) * columns + c % columns;
  };
  for (int c = 0; c < columns; ++c) {
    mesh.triangles.push_back({0, at(1, c), at(1, c + 1)});
    for (int r = 1; r + 1 < rows; ++r) {
      mesh.triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
      mesh.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
    }
    mesh.triangles.push_back({last, at(rows - 1, c + 1), at(rows - 1, c)});
  }
  return mesh;
}

TEST(TriangleMesh, NormalsOfASphereConverge) {
  double previous = 1.0;
  for (const int rows : {16, 32, 64}) {
    TriangleMesh mesh = Sphere(rows, 2 * rows, {1, 2, 3}, 0.01f);
    ComputeVertexNormals(&mesh);
    ASSERT_EQ(mesh.vertices.size(), mesh.normals.size());
    double worst = 0.0;
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Eigen::Vector3f expected =
          (mesh.vertices[v] - Eigen::Vector3f(1, 2, 3)).normalized();
      worst = std::max<double>(worst, (mesh.normals[v] - expected).norm());
    }
    EXPECT_LT(worst, 0.7 * previous) << rows;
    previous = worst;
  }
  // Half a step of the finest grid.
  EXPECT_LT(previous, 0.5 * 3.14159265 / 64);
}

// A corner whose right angles are cut unevenly: the weights must be angles.
TEST(TriangleMesh, NormalsAreAngleWeighted) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 3, 0}};
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 1, 4}, {0, 4, 2}};
  ComputeVertexNormals(&mesh);
  const Eigen::Vector3f expected = Eigen::Vector3f(1, 1, 1).normalized();
  EXPECT_NEAR(0.0f, (mesh.normals[0] - expected).norm(), kUnitTolerance);
}

TEST(TriangleMesh, DegenerateTrianglesAndLooseVertices) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0},      {0, 1, 0},      {2, 0, 0},
                   {7, 7, 7}, {1e-30f, 0, 0}, {0, 1e-30f, 0}, {3e38f, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 1, 1}, {3, 7, 0}};
  ComputeVertexNormals(&mesh);
  for (const Eigen::Vector3f& n : mesh.normals) {
    EXPECT_NEAR(1.0f, n.norm(), kUnitTolerance);
    EXPECT_NEAR(1.0f, n.z(), kUnitTolerance);
  }
  // Tiny but not degenerate; then two faces that cancel.
  mesh.triangles = {{0, 6, 5}};
  ComputeVertexNormals(&mesh);
  EXPECT_NEAR(-1.0f, mesh.normals[0].z(), kUnitTolerance);
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  ComputeVertexNormals(&mesh);
  EXPECT_NEAR(1.0f, mesh.normals[0].norm(), kUnitTolerance);
}

TEST(TriangleMesh, NormalsAgainstFacesWhateverTheWinding) {
  // A fan about (0, 0, 0), flat but for one corner.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0.1f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  ComputeVertexNormals(&mesh);
  EXPECT_TRUE(NormalsAgainstFaces(mesh).empty());
  TriangleMesh turned = mesh;
  turned.normals[2] = {1, 0, 0};  // along its faces
  EXPECT_EQ(std::vector<int>{2}, NormalsAgainstFaces(turned));
  for (Eigen::Vector3f& n : mesh.normals) n = -n;
  EXPECT_TRUE(NormalsAgainstFaces(mesh).empty());
  // Half of the faces are turned: the normals may be right.
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  std::swap(mesh.triangles[2][1], mesh.triangles[2][2]);
  EXPECT_TRUE(NormalsAgainstFaces(mesh).empty());
  // No area, no opinion.
  mesh.vertices.assign(5, {0, 0, 0});
  EXPECT_TRUE(NormalsAgainstFaces(mesh).empty());
}

TEST(TriangleMesh, FitUnitSphere) {
  TriangleMesh mesh;
  mesh.vertices = {{10, 0, 0}, {14, 0, 0}, {12, 1, 0}, {12, -1, 0}};
  const BoundingSphere was = FitUnitSphere(&mesh);
  EXPECT_EQ(Eigen::Vector3d(12, 0, 0), was.centre);
  EXPECT_EQ(2.0, was.radius);
  EXPECT_EQ(Eigen::Vector3f(-1, 0, 0), mesh.vertices[0]);
  EXPECT_EQ(Eigen::Vector3f(1, 0, 0), mesh.vertices[1]);
  EXPECT_EQ(Eigen::Vector3f(0, 0.5f, 0), mesh.vertices[2]);

  TriangleMesh point;
  point.vertices = {{3, 4, 5}, {3, 4, 5}};
  FitUnitSphere(&point);
  EXPECT_EQ(Eigen::Vector3f(0, 0, 0), point.vertices[0]);

  TriangleMesh large;
  large.vertices = {{-3e38f, 0, 0}, {3e38f, 3e38f, 0}};
  FitUnitSphere(&large);
  EXPECT_NEAR(1.0f, large.vertices[1].norm(), kUnitTolerance);

  TriangleMesh empty;
  FitUnitSphere(&empty);
  EXPECT_TRUE(empty.vertices.empty());
}

}  // namespace
}  // namespace ibrdf
