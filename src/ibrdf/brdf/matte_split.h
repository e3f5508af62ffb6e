// A BRDF as a matte part, which paint colours, and a glossy one, which is the
// coat's.
#pragma once
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {

// f = matte + gloss of a scalar field [nodes] >= 0 on a grid, both >= 0:
// matte = min(f, cap), cap the median of f over half vectors that are far from
// the normal (theta_h 40 to 75 degrees), at the same theta_d and phi_d, but at
// least the same median over all theta_d <= 60 degrees. From theta_d = 45
// degrees on, where Fresnel's gloss grows, the cap stays. Light that enters the
// coat and comes out of the paint hardly depends on theta_h (Burley 2012, Sec.
// 3.2), so what rises above is the surface's reflection; what cloth throws back
// whence it came is paint. A mirror is nearly all gloss, plaster not at all.
std::vector<float> MattePart(const BrdfGridShape& shape, const float* field);

// The same of each channel.
BrdfGrid MattePart(const BrdfGrid& brdf);

// MattePart of each lobe's shape, [num_lobes][nodes].
std::vector<float> MatteShapes(const LobeModel& lobes,
                               const double* parameters);

}  // namespace ibrdf
