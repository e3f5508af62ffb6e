// Mesh files read into checked polygons.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

inline constexpr int kMaxPolygonCorners = 4096;

struct PolygonMesh {
  std::vector<Eigen::Vector3d> vertices;  // finite as floats too
  std::vector<Eigen::Vector3f> normals;   // of any length; 0: not finite
  std::vector<int> sizes;                 // corners of each face, >= 3
  std::vector<int> corners;  // vertex of each corner, face after face
  // Normal of each corner; empty unless the file has one for every corner.
  std::vector<int> corner_normals;
};

// Both return at least one face and indices in range. They refuse what has no
// faces, is malformed or cut off, coordinates that a float does not hold, and
// polygons of more than kMaxPolygonCorners corners; the message names file and
// line (OBJ) or element (PLY).

// `bytes`: OBJ text. Everything but vertices, normals and faces is left out.
StatusOr<PolygonMesh> ParseObj(const std::string& path,
                               const std::string& bytes);

// `bytes`: PLY, ascii or binary of either byte order. Uses x y z and nx ny nz
// of the element "vertex" and vertex_indices (or vertex_index) of "face".
StatusOr<PolygonMesh> ParsePly(const std::string& path,
                               const std::string& bytes);

// Adds a vertex; false where a number is not finite as a float.
bool AppendVertex(const double xyz[3], PolygonMesh* mesh);
// Adds a normal; zero where a number is not finite as a float.
void AppendNormal(const double xyz[3], PolygonMesh* mesh);

}  // namespace ibrdf
