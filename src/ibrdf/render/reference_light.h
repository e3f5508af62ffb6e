// A map as the far rule of ReferenceRenderer takes it. Internal.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/render/reference_parts.h"
#include "ibrdf/transport/quadrature.h"
#include "ibrdf/visibility/visibility_grid.h"

namespace ibrdf {

// The cells of the far rule, one entry of each list a cell.
struct ReferenceLight {
  std::vector<FarCell> cells;
  std::vector<Eigen::Array3d> power;  // radiance times solid angle
  std::vector<double> solid_angle;    // sr
  std::vector<GridRange> ranges;      // texels of options.shadows, if any
};

// Blocks of texels (ReferenceOptions::far_width), each at the centroid of its
// light. A block that is bright and uneven is taken texel by texel.
ReferenceLight GatherReferenceLight(const Image& map,
                                    const ReferenceOptions& options);

}  // namespace ibrdf
