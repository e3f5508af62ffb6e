// Gloss as a filter of the light, and the grid of its parameters.
#pragma once
#include <vector>

namespace ibrdf {

// What a lobe of width alpha = roughness^2 leaves of harmonics of degree l,
// seen along the normal; 1 at l = 0.
enum class GlossFilter {
  // exp(-(alpha l)^2), of a Beckmann distribution of slopes: Eq. 28 of Wiersma
  // et al. 2025.
  kBeckmann,
  // x K_1(x), x = 2 alpha l, of a GGX distribution, which renderers have and
  // brdf/disney.h as well. It is the transform of the slopes' density
  // 1 / (pi alpha^2 (1 + s^2 / alpha^2)^2), as Eq. 28 is that of Beckmann's.
  kGgx,
};

// l >= 0, alpha >= 0.
double FilterOf(GlossFilter filter, double alpha, int l);

// Widths on a grid of `count` >= 2 values.
enum class AlphaGrid {
  kUniformRoughness,  // (i / (count - 1))^2: roughness is uniform
  kUniformAlpha,      // i / (count - 1)
};
std::vector<double> AlphaValues(AlphaGrid grid, int count);

// i / (count - 1), count >= 2: what Kd and Ks take.
std::vector<double> UnitValues(int count);

}  // namespace ibrdf
