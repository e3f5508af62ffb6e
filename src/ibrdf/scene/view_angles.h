// What is worked out for some view angles at equal steps and interpolated
// between them, and sums over points in chunks. Internal.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ibrdf/scene/scene.h"

namespace ibrdf {
namespace view_angles {

// Points are joined in this many sums, whatever the number of threads.
inline constexpr int64_t kChunks = 16;

// The part of a list that chunk k of kChunks takes.
inline int64_t ChunkBegin(int64_t k, size_t count) {
  return k * static_cast<int64_t>(count) / kChunks;
}

// From the normal, radians.
inline double MaxViewAngle() { return std::acos(double{kMinViewCosine}); }

// Lagrange's cubic through x = 0, 1, 2, 3.
template <typename Real>
void CubicWeights(double x, Real w[4]) {
  w[0] = static_cast<Real>(-(x - 1) * (x - 2) * (x - 3) / 6);
  w[1] = static_cast<Real>(x * (x - 2) * (x - 3) / 2);
  w[2] = static_cast<Real>(-x * (x - 1) * (x - 3) / 2);
  w[3] = static_cast<Real>(x * (x - 1) * (x - 2) / 6);
}

}  // namespace view_angles
}  // namespace ibrdf
