// Kernels of the flow on blocks of points, one table per instruction set.
#pragma once
#include <cstddef>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/flow/dense_layer.h"

namespace ibrdf {

// Points of a block; activations are [row][kCouplingBlock].
inline constexpr int kCouplingBlock = 64;

// Everything a kernel reads. `first_bias` [layers][widths[0]] holds the first
// dense layer's bias plus its code part, the same for all points of a block.
struct CouplingView {
  int layers, bins, code_size, rows, output_row, num_dense;
  const DenseLayer* dense;
  const float* weights;
  size_t weights_per_layer, code_offset;
  size_t padded_per_layer;
  const float* first_bias;
};

// The gradient of the weights is in a kernel's own layout: per layer, each
// dense layer as [out_count][PaddedCount(in_count)] at padded_offset.
struct CouplingKernels {
  // x: [3][64] in [0,1]; u: [3][64] latent; log_density [64].
  // tape: [layers][rows + 2][64], kept for Backward.
  void (*forward)(const CouplingView&, const float* x, float* tape, float* u,
                  float* log_density);
  // adjoint: [64] of the log density. Optional outputs:
  // weight_gradient: padded layout, added to (biases at bias_gradient
  // [layers][rows], added to); dcode [code_size][64]; dx [3][64].
  // scratch: CouplingScratchFloats(rows).
  void (*backward)(const CouplingView&, const float* tape, const float* adjoint,
                   float* scratch, float* weight_gradient, float* bias_gradient,
                   float* dcode, float* dx);
  // u -> x and its log density. scratch: [rows][64].
  void (*inverse)(const CouplingView&, const float* u, float* scratch, float* x,
                  float* log_density);
};

inline size_t CouplingTapeFloats(const CouplingView& v) {
  return static_cast<size_t>(v.layers) * (v.rows + 2) * kCouplingBlock;
}
inline size_t CouplingScratchFloats(int rows) {
  return static_cast<size_t>(rows) * kCouplingBlock * 2 +
         static_cast<size_t>(PaddedCount(rows)) * kCouplingBlock;
}

const CouplingKernels& GetCouplingKernels(SimdLevel level);

namespace portable {
extern const CouplingKernels kCouplingKernels;
}
namespace avx2 {
extern const CouplingKernels kCouplingKernels;
}
namespace avx512 {
extern const CouplingKernels kCouplingKernels;
}

}  // namespace ibrdf
