// The recurrence of HarmonicBasis on short vectors, a lane a direction. Only
// kernel files include this header, after base/simd.h.
#pragma once

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// Calls store(index, Y) once for every harmonic up to degree `order`. polar:
// cos(theta); zero, side: sin(theta) times cos(phi) and sin(phi).
// V: vector of T. Constants as in HarmonicBasis.
template <typename V, typename T, typename Store>
inline void EvaluateRecurrence(int order, const T* diagonal, const T* up,
                               const T* down, V polar, V zero, V side,
                               const Store& store) {
  V c = V{} + T{1}, s = V{};  // (sin(theta) e^(i phi))^m = c + i s
  for (int m = 0; m <= order; ++m) {
    V before = V{}, p = V{} + diagonal[m];
    for (int l = m; l <= order; ++l) {
      if (l > m) {
        const int at = l * (l + 1) / 2 + m;
        const V next = up[at] * (polar * p) - down[at] * before;
        before = p;
        p = next;
      }
      const int middle = l * (l + 1);
      store(middle + m, p * c);
      if (m > 0) store(middle - m, p * s);
    }
    const V turned = c * zero - s * side;
    s = c * side + s * zero;
    c = turned;
  }
}

}  // namespace
}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
