#include "experiments/benchmarks/flow_speed/machine_peaks.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ibrdf {
namespace {

// Enough to hide the latency of two units.
constexpr int kRegisters = 12;
// Read anew for each register, so that no compiler works the loop out.
volatile float start = 0.5f, factor = 0.999f, term = 0.001f;

#if defined(__x86_64__)
__attribute__((target("sse2"))) float Sse(int64_t rounds) {
  __m128 r[kRegisters];
  for (__m128& v : r) v = _mm_set1_ps(start);
  const __m128 a = _mm_set1_ps(factor), b = _mm_set1_ps(term);
  for (int64_t i = 0; i < rounds; ++i) {
    for (__m128& v : r) v = _mm_add_ps(_mm_mul_ps(v, a), b);
  }
  __m128 sum = _mm_setzero_ps();
  for (const __m128& v : r) sum = _mm_add_ps(sum, v);
  return _mm_cvtss_f32(sum);
}

__attribute__((target("avx2,fma"))) float Avx2(int64_t rounds) {
  __m256 r[kRegisters];
  for (__m256& v : r) v = _mm256_set1_ps(start);
  const __m256 a = _mm256_set1_ps(factor), b = _mm256_set1_ps(term);
  for (int64_t i = 0; i < rounds; ++i) {
    for (__m256& v : r) v = _mm256_fmadd_ps(v, a, b);
  }
  __m256 sum = _mm256_setzero_ps();
  for (const __m256& v : r) sum = _mm256_add_ps(sum, v);
  return _mm256_cvtss_f32(sum);
}

__attribute__((target("avx512f"))) float Avx512(int64_t rounds) {
  __m512 r[kRegisters];
  for (__m512& v : r) v = _mm512_set1_ps(start);
  const __m512 a = _mm512_set1_ps(factor), b = _mm512_set1_ps(term);
  for (int64_t i = 0; i < rounds; ++i) {
    for (__m512& v : r) v = _mm512_fmadd_ps(v, a, b);
  }
  __m512 sum = _mm512_setzero_ps();
  for (const __m512& v : r) sum = _mm512_add_ps(sum, v);
  return _mm512_cvtss_f32(sum);
}
#else
float Sse(int64_t rounds) {
  float r[4 * kRegisters];
  for (float& v : r) v = start;
  for (int64_t i = 0; i < rounds; ++i) {
    for (float& v : r) v = v * factor + term;
  }
  float sum = 0.0f;
  for (const float v : r) sum += v;
  return sum;
}
#endif

volatile float sink;

}  // namespace

int64_t MultiplyAdds(SimdLevel level, int64_t rounds) {
  int lanes = 4;
#if defined(__x86_64__)
  if (level == SimdLevel::kAvx512) {
    sink = Avx512(rounds);
    lanes = 16;
  } else if (level == SimdLevel::kAvx2) {
    sink = Avx2(rounds);
    lanes = 8;
  } else {
    sink = Sse(rounds);
  }
#else
  (void)level;
  sink = Sse(rounds);
#endif
  return 2 * rounds * kRegisters * lanes;
}

int64_t Stream(float* values, size_t count) {
  for (size_t i = 0; i < count; ++i) values[i] += 1.0f;
  return static_cast<int64_t>(2 * count * sizeof(float));
}

}  // namespace ibrdf
