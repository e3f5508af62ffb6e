// Triangle meshes in memory.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace ibrdf {

// Right-handed, counter-clockwise triangles seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;       // per vertex, unit; or empty
  std::vector<std::array<int, 3>> triangles;  // indices of vertices
  // Texture coordinates of each triangle's corners, finite, (0, 0) at the
  // bottom left of the picture; or empty. Corners of one vertex may differ: a
  // seam.
  std::vector<std::array<Eigen::Vector2f, 3>> texture;
};

// Sets normals to the mean of the adjacent faces' normals weighted by the angle
// of the face at the vertex (Thuermer and Wuethrich 1998). Triangles without
// area are skipped; a vertex left without a normal gets (0, 0, 1).
void ComputeVertexNormals(TriangleMesh* mesh);

// The vertices whose normals no adjacent face agrees with: on the other side of
// all of them or, where the faces' winding is mixed, along all of them.
// Vertices without a face of positive area are left out. `mesh` has normals.
std::vector<int> NormalsAgainstFaces(const TriangleMesh& mesh);

struct BoundingSphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the bounding box
  double radius = 0.0;                               // to the farthest vertex
};

// Translates the centre of the bounding box to the origin and scales the
// farthest vertex to distance 1; a mesh of one point is only translated.
// Normals are unchanged. Returns what became the unit sphere.
BoundingSphere FitUnitSphere(TriangleMesh* mesh);

}  // namespace ibrdf
