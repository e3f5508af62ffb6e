// Kernels of the flow on blocks of points, one table per instruction set.
#pragma once
#include <cstddef>

#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {

// Points of a block; activations are [row][kFlowBlock].
inline constexpr int kFlowBlock = 64;

// Dense layer as in flow_shape.h, for C-style kernels.
struct FlowDense {
  int in, in_count, out, out_count;
  int activation;
  size_t weight_offset, bias_offset;
  size_t padded_offset;  // of the gradient [out_count][padded in_count]
};

// Everything a kernel reads. `first_bias` [layers][widths[0]] holds the first
// dense layer's bias plus its code part, the same for all points of a block.
struct FlowView {
  int layers, bins, code_size, rows, output_row, num_dense;
  const FlowDense* dense;
  const float* weights;
  size_t weights_per_layer, code_offset;
  size_t padded_per_layer;
  const float* first_bias;
};

// Weights' gradient in a kernel's own layout: per layer, each dense layer as
// [out_count][PaddedCount(in_count)] at padded_offset: whole vectors of any
// instruction set.
inline int PaddedCount(int n) { return (n + 31) / 32 * 32; }

struct FlowKernels {
  // x: [3][64] in [0,1]; u: [3][64] latent; log_density [64].
  // tape: [layers][rows + 2][64], kept for Backward.
  void (*forward)(const FlowView&, const float* x, float* tape, float* u,
                  float* log_density);
  // adjoint: [64] of the log density. Optional outputs:
  // weight_gradient: padded layout, added to (biases at bias_gradient
  // [layers][rows], added to); dcode [code_size][64]; dx [3][64].
  // scratch: FlowScratchFloats(rows).
  void (*backward)(const FlowView&, const float* tape, const float* adjoint,
                   float* scratch, float* weight_gradient, float* bias_gradient,
                   float* dcode, float* dx);
  // u -> x and its log density. scratch: [rows][64].
  void (*inverse)(const FlowView&, const float* u, float* scratch, float* x,
                  float* log_density);
};

inline size_t FlowTapeFloats(const FlowView& v) {
  return static_cast<size_t>(v.layers) * (v.rows + 2) * kFlowBlock;
}
inline size_t FlowScratchFloats(int rows) {
  return static_cast<size_t>(rows) * kFlowBlock * 2 +
         static_cast<size_t>(PaddedCount(rows)) * kFlowBlock;
}

const FlowKernels& GetFlowKernels(SimdLevel level);

namespace portable {
extern const FlowKernels kFlowKernels;
}
namespace avx2 {
extern const FlowKernels kFlowKernels;
}
namespace avx512 {
extern const FlowKernels kFlowKernels;
}

}  // namespace ibrdf
