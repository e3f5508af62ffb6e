// Mesh files read into checked polygons.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

inline constexpr int kMaxPolygonCorners = 4096;
// The most triangles of strips, and of files that may name one triangle often:
// the file's size does not bound what they take.
inline constexpr size_t kMaxStripTriangles = size_t{1} << 24;

struct PolygonMesh {
  std::vector<Eigen::Vector3d> vertices;  // finite as floats too
  std::vector<Eigen::Vector3f> normals;   // of any length; 0: not finite
  std::vector<int> sizes;                 // corners of each face, >= 3
  std::vector<int> corners;  // vertex of each corner, face after face
  // Normal of each corner; empty unless the file has one for every corner.
  std::vector<int> corner_normals;
  // Texture coordinates, (0, 0) at the bottom left of the picture, and those of
  // each corner; empty unless the file has finite ones for every corner.
  std::vector<Eigen::Vector2f> texture;
  std::vector<int> corner_texture;
  // Why there are none, beginning "expected"; empty where the file has none at
  // all. No error of the mesh, which needs none.
  std::string texture_fault;
};

// All return at least one face and indices in range. They refuse what has no
// faces, is malformed or cut off, coordinates that a float does not hold, and
// polygons of more than kMaxPolygonCorners corners; the message names file and
// line (OBJ), element (PLY), line or triangle (STL), or key (GLB).

// `bytes`: OBJ text. Everything but vertices, normals, texture coordinates and
// faces is left out.
StatusOr<PolygonMesh> ParseObj(const std::string& path,
                               const std::string& bytes);

// `bytes`: PLY, ascii or binary of either byte order. Uses x y z, nx ny nz and
// s t (or u v, texture_u texture_v) of the element "vertex" and vertex_indices
// (or vertex_index) of "face" and of "tristrips", in which -1 begins another
// strip.
StatusOr<PolygonMesh> ParsePly(const std::string& path,
                               const std::string& bytes);

// `bytes`: STL, binary or text. Its normals are of faces, often wrong, and left
// out.
StatusOr<PolygonMesh> ParseStl(const std::string& path,
                               const std::string& bytes);

// `bytes`: glTF 2.0 in one file. The meshes of the scene (the first where the
// file names none; all where it has none), each placed by its node, with their
// normals if all have some, and TEXCOORD_0 likewise. Triangles, strips and fans
// are read, lines and points left out. Compressed and sparse data, skeletons,
// morphs and buffers in other files are refused by name.
StatusOr<PolygonMesh> ParseGlb(const std::string& path,
                               const std::string& bytes);

// Adds a vertex; false where a number is not finite as a float.
bool AppendVertex(const double xyz[3], PolygonMesh* mesh);
// Adds a normal; zero where a number is not finite as a float.
void AppendNormal(const double xyz[3], PolygonMesh* mesh);
// Adds texture coordinates; false, with a fault, where they are not finite as
// floats.
bool AppendTexture(const double uv[2], PolygonMesh* mesh);
// Takes those of the vertices for their corners, where each has some.
void UseVertexTexture(PolygonMesh* mesh);
// Adds a triangle, or nothing where two corners are one; false beyond
// kMaxStripTriangles faces.
bool AppendTriangle(int a, int b, int c, PolygonMesh* mesh);
// Adds the triangles of a strip of vertices, the first of which turns as its
// corners are listed; false beyond kMaxStripTriangles faces.
bool AppendStrip(const std::vector<int>& strip, PolygonMesh* mesh);

}  // namespace ibrdf
