// Depth maps, as normals.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/problem/load_normals.h"

namespace ibrdf {

// Reads geometry.depth and takes its normals (NormalsOfDepth). Values times
// geometry.depth_scale are depth. Holes are 0, values that are not finite, and
// those beyond 1e8 or equal to the largest half float, which renderers write
// where there is nothing.
//
// Refused: lossy files, several channels that differ, whole numbers without a
// scale, depth of 0 or less before a perspective camera, and a file of holes.
StatusOr<NormalMap> LoadDepth(const GeometrySpec& geometry,
                              const Camera& camera);

// The same of a file's bytes; messages call it geometry.file.
StatusOr<NormalMap> DecodeDepth(const GeometrySpec& geometry,
                                const Camera& camera, const std::string& bytes,
                                const ImageLimits& limits = {});

}  // namespace ibrdf
