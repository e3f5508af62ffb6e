// An environment map without the detail that few views cannot tell.
#pragma once
#include "ibrdf/image/image.h"

namespace ibrdf {

// The map with harmonics of degree l times exp(-(alpha l)^2), alpha in (0, 1]:
// as coarse as views sample the light (PrefilterAlpha of band_limit.h). Its
// coefficients are exact integrals; degrees of which less than 1e-6 is left are
// left out, as are those above 100. At least 64 rows. Beside a small sun the
// result rings below 0, by a few hundredths of the sun's peak: a linear filter
// of the harmonics, as the spectra have it.
Image PrefilterMap(const Image& map, double alpha, int num_threads);

}  // namespace ibrdf
