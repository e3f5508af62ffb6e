// Inner loops of the reference renderers, one version per instruction set.
#pragma once

namespace ibrdf {

// Rays whose products are summed in float before they join a sum in double.
inline constexpr int kRayBlock = 128;
// Rows of interleaved tables and maps are a multiple of this many floats.
inline constexpr int kReferenceStride = 16;

// Eight bins of a MERL table and their weights, sum 1 times a factor.
struct MerlTaps {
  int bin[8];
  float weight[8];
};

struct ReferenceKernels {
  // Positions in a map of the n rays x t + y b + z n of unit length; frame: t,
  // b, n. In rows and columns of a PaddedMaps from the centre of its first
  // texel, inside it. n <= kRayBlock.
  void (*place_rays)(const float* x, const float* y, const float* z, int n,
                     const float* frame, int height, int width, float* row,
                     float* column);
  // out[i] = bilinear row of the padded maps at position i < n; rows of
  // `stride` floats.
  void (*look_up_maps)(const float* lanes, int height, int width, int stride,
                       const float* row, const float* column, int n,
                       float* out);
  // out[i] = sum_k weight_k rows[bin_k] over the taps i < n; rows of `stride`
  // floats.
  void (*blend_rows)(const float* rows, int stride, const MerlTaps* taps, int n,
                     float* out);
  // sums[c][l][m] += sum_i f[i][c * num_m + m] g[i][c * num_l + l] for three
  // channels c, i < n <= kRayBlock. f: rows of f_stride floats; the rows of the
  // sums have num_m rounded up to kReferenceStride. Reads up to
  // kReferenceStride floats beyond f.
  void (*add_products)(const float* f, int f_stride, int num_m,
                       const float* const* g, int num_l, int n, double* sums);
};

// The version for ActiveSimdLevel().
const ReferenceKernels& ActiveReferenceKernels();

namespace portable {
extern const ReferenceKernels kReferenceKernels;
}
namespace avx2 {
extern const ReferenceKernels kReferenceKernels;
}
namespace avx512 {
extern const ReferenceKernels kReferenceKernels;
}

}  // namespace ibrdf
