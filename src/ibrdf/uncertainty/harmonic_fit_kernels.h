// The fit of a batch of texels, a lane a texel.
#pragma once

namespace ibrdf {

// Texels are fitted in batches of this many.
inline constexpr int kFitBatch = 16;
// Right-hand sides: RGB of outgoing radiance, then RGB of incoming radiance.
inline constexpr int kFitValues = 6;

// Doubles of the widest vector: a workspace is for any instruction set.
inline constexpr int kMostDoubles = 8;

// A FitBatch and the harmonics, as kernels take them.
struct BatchArguments {
  int order;
  const double *diagonal, *up, *down;  // constants of HarmonicBasis
  int num_views;
  const float *polar, *zero, *side, *weight;  // [num_views, kFitBatch]
  const float* values;  // [num_views, kFitValues, kFitBatch]
};

// What HarmonicFitter hands to its kernel.
struct FitArguments {
  BatchArguments batch;
  const double* regulariser;  // [count]
  double cosine_power;
  double* workspace;     // see FitWorkspaceSize()
  double* coefficients;  // [count, kFitValues, kFitBatch]
};

inline constexpr int kFitTile = 4;
inline int RoundUpToTile(int n) {
  return (n + kFitTile - 1) / kFitTile * kFitTile;
}

namespace portable {
void FitHarmonics(const FitArguments& arguments);
}
namespace avx2 {
void FitHarmonics(const FitArguments& arguments);
}
namespace avx512 {
void FitHarmonics(const FitArguments& arguments);
}

}  // namespace ibrdf
