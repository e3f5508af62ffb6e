// What a number of views can resolve: Appendix C of Wiersma et al. 2025.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/uncertainty/entropy_maps.h"

namespace ibrdf {

// The share of a degree's amplitude that a lobe must have lost, for the degree
// to count as smoothed away: t of Eq. 27.
inline constexpr double kAttenuation = 0.5;

// alpha' = sqrt(-log t) / l* with l* = sqrt(num_views): the least alpha =
// roughness^2 that so many views, spread over the sphere, can resolve (Eq. 27).
// num_views >= 1, t in (0, 1). The text states 0.07 for 400 views and t = 0.5,
// which does not follow from its formula; that gives 0.042.
double LeastAlpha(int num_views, double t = kAttenuation);

// The inverse: views that a roughness in (0, 1] needs.
int ViewsForRoughness(double roughness, double t = kAttenuation);

// The width by which the map is smoothed before it is sampled by so many views.
// The published code takes 1 / floor(sqrt(num_views)), which we follow; the
// text has 1 / sqrt(num_views).
double PrefilterAlpha(int num_views);

struct BandLimitOptions {
  // A texel is below the band limit where the best parameters leave more than
  // this share of the observations unexplained, and
  double misfit = 0.1;
  // more than so many standard deviations of the noise.
  double deviations = 3.0;
};

// [num_texels]: 1 where even the best parameters do not explain what is seen,
// in each of the channels. Eq. 28 then tells nothing: alpha may be below
// LeastAlpha, the light may be hidden, or the surface is none of the model.
std::vector<uint8_t> BelowBandLimit(const EntropyMaps& maps,
                                    const BandLimitOptions& options = {});

}  // namespace ibrdf
