// Entropy to expect of observations that are not made yet, a lane a candidate.
#pragma once
#include "ibrdf/uncertainty/spectrum_kernels.h"

namespace ibrdf {

struct ExpectedSignals {
  const float* hypothetical;  // filter of what is observed, as grid.filter
  const float* scale;         // [num_ks]: distances of observations of k_j
  const float* probability;   // [num_alpha, num_ks]: of the parameters
  int64_t stride;
  const float* incoming;  // A [num_degrees, stride]
  int count;
  float* expected;  // [count]: sum_psi p(psi) H(B_psi, L), over log of cells
};

namespace portable {
void ExpectedEntropy(const SpectrumGrid& grid, const ExpectedSignals& signals);
}
namespace avx2 {
void ExpectedEntropy(const SpectrumGrid& grid, const ExpectedSignals& signals);
}
namespace avx512 {
void ExpectedEntropy(const SpectrumGrid& grid, const ExpectedSignals& signals);
}

}  // namespace ibrdf
