// Entropy over the grid of (alpha, Ks) from spectra, a lane a signal.
#pragma once
#include <cstdint>

namespace ibrdf {

// Values of alpha, and of Ks, that a grid may have.
inline constexpr int kMostGridValues = 256;

// Distances are x_ij = sum_l (k_j e_il A_l - B_l)^2, and p_ij is proportional
// to exp(-x_ij - penalty_ij).
struct SpectrumGrid {
  int num_degrees, num_alpha, num_ks;
  const float* filter;   // e [num_alpha, num_degrees]
  const float* factor;   // k [num_ks]
  const float* penalty;  // [num_alpha, num_ks], >= 0, or null
};

struct SpectrumSignals {
  int64_t stride;
  const float *incoming, *outgoing;  // A, B [num_degrees, stride]
  int count;
  // [count]: entropy over log(num_alpha num_ks); x of the most probable cell,
  // and its index i num_ks + j.
  float *entropy, *distance;
  int32_t* cell;
};

namespace portable {
void SpectrumEntropy(const SpectrumGrid& grid, const SpectrumSignals& signals);
}
namespace avx2 {
void SpectrumEntropy(const SpectrumGrid& grid, const SpectrumSignals& signals);
}
namespace avx512 {
void SpectrumEntropy(const SpectrumGrid& grid, const SpectrumSignals& signals);
}

}  // namespace ibrdf
