// Matrix products and activations of the conditioner networks, for kernel files
// alone (see base/simd.h). Activations are [row][columns], a point or column of
// a table in each lane.
#pragma once
#include "ibrdf/base/simd.h"
#include "ibrdf/flow/dense_layer.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// C[i][j] (+)= sum_k A[i * a_row + k * a_col] B[k][j] for M rows of C and two
// vectors of columns: the one inner loop of all matrix products here.
template <int M, bool kAdd>
inline void Tile(int depth, const float* a, size_t a_row, size_t a_col,
                 const float* b, size_t b_row, float* c, size_t c_row,
                 const float* bias) {
  Vf acc0[M], acc1[M];
#pragma GCC unroll 8
  for (int i = 0; i < M; ++i) {
    acc0[i] = acc1[i] = bias != nullptr ? Splat(bias[i]) : Vf{};
  }
  for (int k = 0; k < depth; ++k) {
    const Vf b0 = Load(b + k * b_row);
    const Vf b1 = Load(b + k * b_row + kLanes);
#pragma GCC unroll 8
    for (int i = 0; i < M; ++i) {
      const Vf w = Splat(a[i * a_row + k * a_col]);
      acc0[i] += w * b0;
      acc1[i] += w * b1;
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < M; ++i) {
    float* out = c + i * c_row;
    Store(out, kAdd ? Load(out) + acc0[i] : acc0[i]);
    Store(out + kLanes, kAdd ? Load(out + kLanes) + acc1[i] : acc1[i]);
  }
}

// The product for any number of rows; columns: a multiple of 2 kLanes.
template <bool kAdd>
inline void Product(int rows, int columns, int depth, const float* a,
                    size_t a_row, size_t a_col, const float* b, size_t b_row,
                    float* c, size_t c_row, const float* bias) {
  constexpr int kRows = kLanes == 16 ? 8 : (kLanes == 8 ? 6 : 4);
  for (int j = 0; j < columns; j += 2 * kLanes) {
    int i = 0;
    for (; i + kRows <= rows; i += kRows) {
      Tile<kRows, kAdd>(depth, a + i * a_row, a_row, a_col, b + j, b_row,
                        c + i * c_row + j, c_row, bias ? bias + i : nullptr);
    }
    for (; i + 2 <= rows; i += 2) {
      Tile<2, kAdd>(depth, a + i * a_row, a_row, a_col, b + j, b_row,
                    c + i * c_row + j, c_row, bias ? bias + i : nullptr);
    }
    for (; i < rows; ++i) {
      Tile<1, kAdd>(depth, a + i * a_row, a_row, a_col, b + j, b_row,
                    c + i * c_row + j, c_row, bias ? bias + i : nullptr);
    }
  }
}

[[maybe_unused]] inline Vf Abs(Vf x) { return AsFloat(AsInt(x) & 0x7fffffff); }

// In place, on `count` floats, a multiple of kLanes.
[[maybe_unused]] inline void Activate(float* x, int count) {
  constexpr float kSharp = static_cast<float>(kSharpness);
  for (int i = 0; i < count; i += kLanes) {
    const Vf v = Load(x + i);
    const Vf t = Sqrt(v * v + kSharp) + Abs(v);
    Store(x + i, Select(v > 0.0f, t * 0.5f, (0.5f * kSharp) / t));
  }
}

// act'(x), written by the activation y alone.
[[maybe_unused]] inline Vf ActivationSlope(Vf y) {
  const Vf y2 = 4.0f * y * y;
  return y2 / (y2 + static_cast<float>(kSharpness));
}

// g *= act'(x) on `count` floats.
[[maybe_unused]] inline void ActivationAdjoint(const float* y, float* g,
                                               int count) {
  for (int i = 0; i < count; i += kLanes) {
    Store(g + i, Load(g + i) * ActivationSlope(Load(y + i)));
  }
}

// [count][columns] -> [columns][padded], zeros beyond count.
template <int kColumns>
void TransposeRows(const float* rows, int count, int padded, float* out) {
  for (int k = 0; k < padded; k += kLanes) {
    for (int p = 0; p < kColumns; p += kLanes) {
      Vf tile[kLanes];
      for (int i = 0; i < kLanes; ++i) {
        tile[i] = k + i < count ? Load(rows + (k + i) * kColumns + p) : Vf{};
      }
      Transpose(tile);
      for (int i = 0; i < kLanes; ++i) {
        Store(out + (p + i) * padded + k, tile[i]);
      }
    }
  }
}

// Adds the gradient of one layer from the adjoints g [out_count][columns] of
// its products and its inputs [in_count][columns]: biases to gb [out_count],
// weights to gw [out_count][PaddedCount(in_count)]. transposed: room for
// columns * PaddedCount(in_count) floats.
template <int kColumns>
void AddLayerGradient(const DenseLayer& d, const float* inputs, const float* g,
                      float* transposed, float* gb, float* gw) {
  for (int o = 0; o < d.out_count; ++o) {
    Vf sum = Vf{};
    for (int p = 0; p < kColumns; p += kLanes)
      sum += Load(g + o * kColumns + p);
    gb[o] += Sum(sum);
  }
  const int padded =
      (d.in_count + 2 * kLanes - 1) / (2 * kLanes) * (2 * kLanes);
  TransposeRows<kColumns>(inputs, d.in_count, padded, transposed);
  Product<true>(d.out_count, padded, kColumns, g, kColumns, 1, transposed,
                padded, gw, PaddedCount(d.in_count), nullptr);
}

}  // namespace
}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
