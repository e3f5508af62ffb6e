// The clamped cosine in spherical harmonics.
#pragma once
#include <vector>

#include "ibrdf/approximation/harmonics.h"

namespace ibrdf {

// int max(cos, 0) Y_l0 of each degree [order + 1], cos that of the angle to the
// polar axis: the irradiance of harmonics in the frame of the normal. Times
// sqrt(4 pi / (2 l + 1)) it is what the cosine leaves of degree l about any
// normal.
std::vector<double> CosineLobe(const HarmonicBasis& basis);

}  // namespace ibrdf
