// Entropy over the grid of (alpha, Ks) from spectra, a lane a signal.
#pragma once
#include <cstdint>

namespace ibrdf {

// Values of alpha, and of Ks, that a grid may have.
inline constexpr int kMostGridValues = 256;

// A and B stay below this, so that squares are finite.
inline constexpr float kLargestSignal = 1e15f;

// Distances are x_ij = sum_l (k_j e_il A_l - B_l)^2, and p_ij is proportional
// to exp(-x_ij - penalty_ij).
struct SpectrumGrid {
  int num_degrees, num_alpha, num_ks;
  const float* filter;   // e [num_alpha, num_degrees]
  const float* factor;   // k [num_ks]
  const float* penalty;  // [num_alpha, num_ks], >= 0, or null
};

// How A and B come from the powers S_L and S_B of degree l: S or, with `roots`,
// its root, times scale_l; with relative_floor > 0 in units of S_L +
// relative_floor, or its root; times S_B(0) where it is given.
struct SpectrumScale {
  bool roots;
  float relative_floor;
  const float* scale;       // [num_degrees]
  const float* outgoing_0;  // S_B(0) [count], or null
};

struct SpectrumSignals {
  int64_t stride;
  const float *incoming, *outgoing;  // S_L, S_B [num_degrees, stride]
  int count;
  // [count]: entropy over log(num_alpha num_ks); x of the most probable cell,
  // its share of sum_l B_l^2, and the index i num_ks + j of the cell.
  float *entropy, *distance, *misfit;
  int32_t* cell;
};

namespace portable {
void SpectrumEntropy(const SpectrumGrid& grid, const SpectrumScale& scale,
                     const SpectrumSignals& signals);
}
namespace avx2 {
void SpectrumEntropy(const SpectrumGrid& grid, const SpectrumScale& scale,
                     const SpectrumSignals& signals);
}
namespace avx512 {
void SpectrumEntropy(const SpectrumGrid& grid, const SpectrumScale& scale,
                     const SpectrumSignals& signals);
}

}  // namespace ibrdf
