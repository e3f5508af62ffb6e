// Moments and entropy of the angular model, a lane a texel or a signal.
#pragma once
#include <cstdint>

#include "ibrdf/uncertainty/harmonic_fit_kernels.h"

namespace ibrdf {

// Moments of a channel under one alpha, each a sum over views of weight times:
// y, y y, x, x x, x y.
inline constexpr int kAngularMoments = 5;

// The texels of a FitBatch. Radiance is Kd D + x Ks + x_0, y = B - x_0.
struct AngularArguments {
  BatchArguments batch;
  int num_alpha;
  const double* filter;  // [num_alpha, order + 1]
  const double* alpha;   // [num_alpha]
  bool fresnel, masking;
  const double* coefficients;  // [count, kFitValues, kFitBatch]
  double* workspace;           // AngularWorkspaceSize()
  double* moments;             // [num_alpha, 3, kAngularMoments, kFitBatch]
};

// The workspace has 3 (order + 1) + 4 numbers a view and lane.
inline int64_t AngularWorkspaceSize(int order, int num_views, int lanes) {
  return static_cast<int64_t>(num_views) * lanes * (3 * (order + 1) + 4);
}

// Distances on the grid of (alpha, Ks, Kd):
//   x = rest + a (Kd - Kd_best)^2 + c (Ks - offset + slope Kd)^2.
enum AngularRow { kRest, kMatte, kMatteBest, kGloss, kOffset, kSlope };
inline constexpr int kAngularRows = 6;

struct AngularGrid {
  int num_alpha, num_ks, num_kd;
  const float *Ks, *Kd;  // [num_ks], [num_kd]
  const float* penalty;  // [num_alpha, num_ks], >= 0, or null
};

struct AngularSignals {
  const float* rows;  // [num_alpha, kAngularRows, count]
  int count;          // a multiple of 16
  float* entropy;     // [count], over log(num_alpha num_ks num_kd)
};

namespace portable {
void AngularMoments(const AngularArguments& arguments);
void AngularEntropy(const AngularGrid& grid, const AngularSignals& signals);
}  // namespace portable
namespace avx2 {
void AngularMoments(const AngularArguments& arguments);
void AngularEntropy(const AngularGrid& grid, const AngularSignals& signals);
}  // namespace avx2
namespace avx512 {
void AngularMoments(const AngularArguments& arguments);
void AngularEntropy(const AngularGrid& grid, const AngularSignals& signals);
}  // namespace avx512

}  // namespace ibrdf
