// Triangle meshes from OBJ and PLY files.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/triangle_mesh.h"

namespace ibrdf {

// Reads .obj or .ply (by extension, in any case; others are refused). All
// objects and groups become one mesh; polygons are cut into triangles; lines
// and points are dropped, and so are vertices that no face uses. Materials and
// texture coordinates are ignored.
// Normals: the file's, when every face corner has a finite one longer than 0
// (vertices are then joined by position and normal, which keeps hard edges);
// else vertices are joined by position alone and ComputeVertexNormals is used.
// Refuses files over 512 MiB, without faces, with non-finite coordinates or
// with face indices out of range; the message names the file.
StatusOr<TriangleMesh> ReadMesh(const std::string& path);

}  // namespace ibrdf
