// Mesh files reduced to checked geometry. The importer trusts its input: it
// reads outside its arrays or aborts when an index or a count is wrong.
#pragma once
#include <string>

#include "ibrdf/base/status.h"

namespace ibrdf {

inline constexpr int kMaxPolygonCorners = 4096;

// Both return OBJ text of the geometry alone: lines "v x y z" with finite
// numbers that a float holds, "vn x y z", and "f a b c ..." or
// "f a//n b//n c//n ..." with positive indices in range. Normals are left out
// unless every corner has a finite one. They refuse what has no faces, is
// malformed or cut off, and polygons of more than kMaxPolygonCorners corners;
// the message names file and line (OBJ) or element (PLY).

// `bytes`: OBJ text. Relative indices are resolved; everything but vertices,
// normals and faces is left out.
StatusOr<std::string> CleanObj(const std::string& path,
                               const std::string& bytes);

// `bytes`: PLY, ascii or binary of either byte order. Uses x y z and nx ny nz
// of the element "vertex" and vertex_indices (or vertex_index) of "face".
StatusOr<std::string> CleanPly(const std::string& path,
                               const std::string& bytes);

// Appends "keyword x y z\n" with the shortest decimals that give the same
// floats; false where a number is not finite as a float.
bool AppendObjVector(const char* keyword, const double xyz[3],
                     std::string* text);

}  // namespace ibrdf
