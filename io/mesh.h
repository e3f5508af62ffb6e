// Triangle meshes from OBJ, PLY, STL and GLB files.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/triangle_mesh.h"

namespace ibrdf {

struct MeshNotes {
  // What was subtracted from the file's coordinates; 0 where they are near the
  // origin.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<std::string> warnings;  // sentences that name the file
  // Why the mesh has no texture coordinates although the file has some,
  // beginning "expected"; else empty.
  std::string texture_fault;
};

// Reads .obj, .ply, .stl or .glb (by extension, in any case; others are
// refused). All objects and groups become one mesh, and so do the nodes of a
// GLB's scene, each in its place; polygons are cut into triangles; lines
// and points are dropped, and so are vertices that no face uses. Materials are
// ignored. Texture coordinates are kept where every face corner has finite
// ones.
// Coordinates far from the origin against the mesh's size, as georeferenced
// ones are, are taken from its centre before they become floats
// (notes->origin). Vertices are joined by position, so shading is smooth across
// texture seams. Normals: the file's, when every face corner has a finite one
// longer than 0 and the corners at one position agree; else
// ComputeVertexNormals. A file with a normal per face (flat shading, hard
// edges) is thus smoothed. Normals that all faces around contradict
// (NormalsAgainstFaces) are computed too, all where they are more than one in a
// hundred. What is replaced for being bad is noted. Refuses files over 512 MiB,
// without faces, with non-finite coordinates or with face indices out of range;
// the message names the file.
StatusOr<TriangleMesh> ReadMesh(const std::string& path,
                                MeshNotes* notes = nullptr);

// The same of a file's bytes; messages call it `path`, whose extension says
// what they are.
StatusOr<TriangleMesh> DecodeMesh(const std::string& path,
                                  const std::string& bytes,
                                  MeshNotes* notes = nullptr);

}  // namespace ibrdf
