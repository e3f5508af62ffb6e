// Texture coordinates of meshes that have none.
#pragma once
#include "ibrdf/geometry/triangle_mesh.h"

namespace ibrdf {

// Sets texture coordinates in [0, 1]^2, no two places of the surface at one
// point: connected triangles whose normals are nearest to the same axis are
// seen along it as one chart, unless they overlap there; charts of all axes
// have one scale, and lie side by side with gaps of 1/256, a texel of an atlas
// of that size; smaller ones where there are thousands. Triangles without area
// are points. The same mesh has the same charts anywhere.
void AddCharts(TriangleMesh* mesh);

// Number of charts of texture coordinates: parts whose triangles share edges
// on the surface and in the picture.
int CountCharts(const TriangleMesh& mesh);

}  // namespace ibrdf
