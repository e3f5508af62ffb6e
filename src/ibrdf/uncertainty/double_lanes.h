// Short vectors of doubles, half as many as floats. Only kernel files include
// this header, after base/simd.h.
#pragma once

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

constexpr int kDoubles = kLanes / 2;
using Vd [[gnu::vector_size(IBRDF_SIMD_WIDTH * 4), gnu::may_alias]] = double;

[[maybe_unused]] inline Vd LoadDoubles(const double* p) {
  Vd v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}
[[maybe_unused]] inline void StoreDoubles(double* p, Vd v) {
  std::memcpy(p, &v, sizeof(v));
}
[[maybe_unused]] inline Vd Widen(const float* p) {
  Vd v;
  for (int i = 0; i < kDoubles; ++i) v[i] = p[i];
  return v;
}
[[maybe_unused]] inline Vd SqrtDoubles(Vd v) {
  for (int i = 0; i < kDoubles; ++i) v[i] = __builtin_sqrt(v[i]);
  return v;
}

}  // namespace
}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
