// Short-vector arithmetic for kernels that are compiled once per instruction
// set (see simd_dispatch.h). Only such kernel files include this header; all
// names have internal linkage so that no instruction set leaks into another.
#pragma once
#include <cstdint>
#include <cstring>
#if defined(__SSE__)
#include <immintrin.h>
#endif

#if !defined(IBRDF_SIMD_NAMESPACE) || !defined(IBRDF_SIMD_WIDTH)
#error "compile through ibrdf_add_simd_kernels()"
#endif

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

constexpr int kLanes = IBRDF_SIMD_WIDTH;  // floats per vector
using Vf [[gnu::vector_size(IBRDF_SIMD_WIDTH * 4), gnu::may_alias]] = float;
using Vi [[gnu::vector_size(IBRDF_SIMD_WIDTH * 4), gnu::may_alias]] = int32_t;

[[maybe_unused]] inline Vf Load(const float* p) {
  Vf v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}
[[maybe_unused]] inline void Store(float* p, Vf v) {
  std::memcpy(p, &v, sizeof(v));
}
// Minus zero is x in every case, so that no instruction is spent on it.
[[maybe_unused]] inline Vf Splat(float x) { return x - Vf{}; }
[[maybe_unused]] inline Vi AsInt(Vf v) {
  Vi r;
  std::memcpy(&r, &v, sizeof(r));
  return r;
}
[[maybe_unused]] inline Vf AsFloat(Vi v) {
  Vf r;
  std::memcpy(&r, &v, sizeof(r));
  return r;
}
// m: all ones or zeros per lane (the result of a comparison).
[[maybe_unused]] inline Vf Select(Vi m, Vf a, Vf b) {
  return AsFloat((m & AsInt(a)) | (~m & AsInt(b)));
}
[[maybe_unused]] inline Vf Min(Vf a, Vf b) { return Select(a < b, a, b); }
[[maybe_unused]] inline Vf Max(Vf a, Vf b) { return Select(a > b, a, b); }
[[maybe_unused]] inline float Sum(Vf v) {
  float s = 0.0f;
  for (int i = 0; i < kLanes; ++i) s += v[i];
  return s;
}
// By intrinsics: compilers take a loop over lanes apart into scalar roots.
[[maybe_unused]] inline Vf Sqrt(Vf v) {
#if IBRDF_SIMD_WIDTH == 16
  // The masked form spares GCC 12 a false warning about its own header.
  return (Vf)_mm512_maskz_sqrt_ps(0xffff, (__m512)v);
#elif IBRDF_SIMD_WIDTH == 8
  return (Vf)_mm256_sqrt_ps((__m256)v);
#elif defined(__SSE__)
  return (Vf)_mm_sqrt_ps((__m128)v);
#else
  for (int i = 0; i < kLanes; ++i) v[i] = __builtin_sqrtf(v[i]);
  return v;
#endif
}

// base[index[i]] in lane i.
[[maybe_unused]] inline Vf GatherFloats(const float* base, Vi index) {
#if IBRDF_SIMD_WIDTH == 16
  return (Vf)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff,
                                      (__m512i)index, base, 4);
#elif IBRDF_SIMD_WIDTH == 8
  return (Vf)_mm256_i32gather_ps(base, (__m256i)index, 4);
#else
  Vf v;
  for (int i = 0; i < kLanes; ++i) v[i] = base[index[i]];
  return v;
#endif
}

// Lane i is lane index[i] of a and b, one after the other.
[[maybe_unused]] inline Vf Shuffle(Vf a, Vf b, Vi index) {
#if defined(__clang__)  // which shuffles by constants only
  Vf v;
  for (int i = 0; i < kLanes; ++i) {
    v[i] = index[i] < kLanes ? a[index[i]] : b[index[i] - kLanes];
  }
  return v;
#else
  return __builtin_shuffle(a, b, index);
#endif
}

// Transposes kLanes vectors of kLanes floats in place, by log2(kLanes) perfect
// shuffles of pairs.
[[maybe_unused]] inline void Transpose(Vf* rows) {
  Vi low = Vi{}, high = Vi{};
  for (int i = 0; i < kLanes; ++i) {
    low[i] = i / 2 + (i % 2) * kLanes;
    high[i] = low[i] + kLanes / 2;
  }
#pragma GCC unroll 4
  for (int stage = 1; stage < kLanes; stage *= 2) {
    Vf mixed[kLanes];
#pragma GCC unroll 8
    for (int i = 0; i < kLanes / 2; ++i) {
      mixed[2 * i] = Shuffle(rows[i], rows[i + kLanes / 2], low);
      mixed[2 * i + 1] = Shuffle(rows[i], rows[i + kLanes / 2], high);
    }
#pragma GCC unroll 16
    for (int i = 0; i < kLanes; ++i) rows[i] = mixed[i];
  }
}

// exp(x), relative error below 2e-7 on [-87, 88]; clamped outside.
// Range reduction by log 2 in two parts, degree-6 polynomial on +-log(2)/2.
[[maybe_unused]] inline Vf Exp(Vf x) {
  x = Min(Max(x, Splat(-87.0f)), Splat(88.0f));
  const Vf shift = Splat(12582912.0f);  // 1.5 * 2^23: rounds to nearest
  const Vf t = x * 1.44269504f + shift;
  const Vf n = t - shift;
  const Vf r = x - n * 0.693359375f + n * 2.12194440e-4f;
  Vf p = Splat(1.0f / 720.0f);
  p = p * r + 1.0f / 120.0f;
  p = p * r + 1.0f / 24.0f;
  p = p * r + 1.0f / 6.0f;
  p = p * r + 0.5f;
  p = p * r + 1.0f;
  p = p * r + 1.0f;
  const Vi exponent = (AsInt(t) << 23);
  return AsFloat(AsInt(p) + exponent);
}

// log(x) for finite x > 0, normal; error below 1.5e-7 max(1, |log x|).
// x = 2^e m with m in [sqrt(1/2), sqrt(2)); atanh series in s = (m-1)/(m+1).
[[maybe_unused]] inline Vf Log(Vf x) {
  const Vi bits = AsInt(x);
  const Vi e = (bits - 0x3f3504f3) >> 23;
  const Vf m = AsFloat(bits - (e << 23));
  const Vf s = (m - 1.0f) / (m + 1.0f);
  const Vf s2 = s * s;
  Vf p = Splat(2.0f / 9.0f);
  p = p * s2 + 2.0f / 7.0f;
  p = p * s2 + 2.0f / 5.0f;
  p = p * s2 + 2.0f / 3.0f;
  p = p * s2 + 2.0f;
  const Vf ef = __builtin_convertvector(e, Vf);
  return (p * s + ef * -2.12194440e-4f) + ef * 0.693359375f;
}

}  // namespace
}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
