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
// Vertices are joined by position, so shading is smooth across texture seams.
// Normals: the file's, when every face corner has a finite one longer than 0
// and the corners at one position agree; else ComputeVertexNormals. A file with
// a normal per face (flat shading, hard edges) is thus smoothed.
// Refuses files over 512 MiB, without faces, with non-finite coordinates or
// with face indices out of range; the message names the file.
StatusOr<TriangleMesh> ReadMesh(const std::string& path);

// The same of a file's bytes, read as PLY unless `path` says .obj; messages
// call it `path`.
StatusOr<TriangleMesh> DecodeMesh(const std::string& path,
                                  const std::string& bytes);

}  // namespace ibrdf
