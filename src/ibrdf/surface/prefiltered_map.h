// An environment map without the detail that few views cannot tell.
#pragma once
#include "ibrdf/image/image.h"

namespace ibrdf {

// alpha' = 1 / floor(sqrt(views)): the width of the blur that makes the light
// as coarse as that many views sample it (Wiersma et al. 2025, Appendix C).
// views >= 1.
double PrefilterAlpha(int views);

// The map with harmonics of degree l times exp(-(alpha l)^2), in (0, 1]. Its
// coefficients are exact integrals; degrees of which less than 1e-6 is left are
// left out, as are those above 100. At least 64 rows. Beside a small sun the
// result rings below 0, by a few hundredths of the sun's peak: a linear filter
// of the harmonics, as the spectra have it.
Image PrefilterMap(const Image& map, double alpha, int num_threads);

}  // namespace ibrdf
