// Kernels of the triangular flow on blocks of table columns, one table per
// instruction set.
#pragma once
#include <cstddef>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/flow/dense_layer.h"

namespace ibrdf {

// Columns (x_d, x_p) of a block, one in each lane.
inline constexpr int kColumnBlock = 32;
inline constexpr int kMaxSplineBins = 64;

// One conditioner with its spline, as kernels read it. Activations `rows` are
// [rows][32]: features (filled by the caller), hidden layers, parameters.
struct ConditionerView {
  int bins, heights, rows, output_row, num_dense, code_size;
  const DenseLayer* dense;
  const float* weights;
  size_t code_offset;
  // Either the first layer's bias plus its code part, the same in all lanes, or
  // null: then `codes` [code_size][32] holds a code per lane.
  const float* first_bias;
  const float* codes;
};

struct TriangularKernels {
  // Fills the rows below the features.
  void (*condition)(const ConditionerView&, float* rows);

  // log density of the spline at x [points][32] in [0, 1]; `base` [32] is added
  // where not null. log_density [points][32].
  void (*evaluate)(const ConditionerView&, const float* rows, const float* x,
                   int points, const float* base, float* log_density);

  // From the adjoint [points][32] of the log densities, the adjoint of the
  // spline's parameters, into the last rows of grows, and of x where dx is not
  // null.
  void (*adjoint)(const ConditionerView&, const float* rows, const float* x,
                  int points, const float* adjoint, float* grows, float* dx);

  // The rest of the backward pass; grows is zero but for the parameters.
  // scratch: 32 * PaddedCount(rows) floats. weight_gradient: padded layout,
  // added to, with the biases at bias_gradient [rows] and the code's weights at
  // code_weight_gradient [first layer][PaddedCount(code_size)]; null: none.
  // dcode [code_size][32] is added to; null: none. dfeatures: whether rows of
  // the features are wanted in grows.
  void (*backward)(const ConditionerView&, const float* rows, float* grows,
                   float* scratch, float* weight_gradient, float* bias_gradient,
                   float* code_weight_gradient, float* dcode, bool dfeatures);

  // Derivatives by the code of the log density as piecewise linear functions of
  // x: pieces [bins][code_size][2][32], value and slope at the left knot.
  // scratch: 2 * code_size * 32 * (widest layer) floats. One code in all lanes.
  void (*code_pieces)(const ConditionerView&, const float* rows, float* scratch,
                      float* pieces);
  // Adds them up at x [points][32]: derivative j at point i and lane l goes to
  // out[j * code_stride + i * point_stride + l] for lanes < `lanes`, on top of
  // base [code_size][32] (null: zero).
  void (*code_gradient)(const ConditionerView&, const float* rows,
                        const float* pieces, const float* x, int points,
                        const float* base, int lanes, size_t code_stride,
                        size_t point_stride, float* out);
};

const TriangularKernels& GetTriangularKernels(SimdLevel level);

namespace portable {
extern const TriangularKernels kTriangularKernels;
}
namespace avx2 {
extern const TriangularKernels kTriangularKernels;
}
namespace avx512 {
extern const TriangularKernels kTriangularKernels;
}

}  // namespace ibrdf
