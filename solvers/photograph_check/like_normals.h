// How much pixels of like normals differ: what no single material under one
// distant light explains, if nothing shadows or lights the object from itself.
#pragma once
#include <vector>

#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {

struct LikeNormalsSpread {
  // Mean absolute deviations, natural logarithm. The first is a floor of the
  // misfit (mean |log L_o - log I| over pixels and channels).
  double log_radiance = 0.0;  // mean over the channels
  double log_colour = 0.0;    // mean over log R/G and log B/G
  size_t pixels = 0;          // that they are taken over; 0: too few
  // Per point of the list that the samples were made of: the length of its
  // deviation in (log R/G, log B/G); NaN where it is no sample.
  std::vector<float> colour_of_point;
};

// Divides the disc of normals into cells of 12 to 24 samples of most alike
// normals. Within each, log radiance is a linear function of the normal, so
// that what normals explain is no spread; deviations from it are scaled for the
// degrees of freedom that it takes. `points`: how many the samples are of.
LikeNormalsSpread SpreadOfLikeNormals(std::vector<NormalSample> samples,
                                      size_t points);

}  // namespace ibrdf
