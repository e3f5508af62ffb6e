// The light's correlation by Fourier transform along the rows of a map.
#pragma once
#include <vector>

#include "solvers/marginal/dense_algebra.h"

namespace ibrdf {

// exp(-angle / correlation) between texels (LightCorrelation) is the same at
// every longitude: with F an orthonormal real Fourier basis along the rows,
// C = F^T diag_k(S_k) F, S_k [H][H] for each frequency. A product takes
// O(W H (W + H)) instead of (W H)^2.
class LightSpectrum {
 public:
  // width even.
  LightSpectrum(int height, int width, double correlation_degrees);

  int height() const { return height_; }
  int width() const { return width_; }
  int num_frequencies() const { return width_ / 2 + 1; }
  // Columns of [column][coefficient]: constant, then cosine and sine of each
  // frequency; the highest has a cosine alone. FrequencyOf names them.
  const RowMatrix& basis() const { return basis_; }
  static int FrequencyOf(int coefficient) { return (coefficient + 1) / 2; }
  // S_k, symmetric, positive definite.
  const RowMatrix& block(int frequency) const { return blocks_[frequency]; }

  // out = X C for rows of maps: X [n][H W].
  void Multiply(const RowMatrix& X, RowMatrix* out) const;

 private:
  const int height_, width_;
  RowMatrix basis_;
  std::vector<RowMatrix> blocks_;
};

}  // namespace ibrdf
