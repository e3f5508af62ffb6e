// Inner loop of Transport::RenderLobes and ReflectanceOperator.
#pragma once
#include <cstdint>

namespace ibrdf {

// Floats per node in the fields' array are a multiple of this.
inline constexpr int kLobeStride = 16;
inline int LobeStride(int num_fields) {
  return (num_fields + kLobeStride - 1) / kLobeStride * kLobeStride;
}

// out[k * 3 + c] = sum_i fields[nodes[i] * stride + k] g[i * 4 + c],
// k < stride, c < 3, summed over i in order. stride: multiple of kLobeStride.
using ContractLobesFunction = void (*)(const uint32_t* nodes, int count,
                                       const float* g, const float* fields,
                                       int stride, float* out);

// The version for ActiveSimdLevel().
ContractLobesFunction ContractLobes();

namespace portable {
void ContractLobes(const uint32_t* nodes, int count, const float* g,
                   const float* fields, int stride, float* out);
}
namespace avx2 {
void ContractLobes(const uint32_t* nodes, int count, const float* g,
                   const float* fields, int stride, float* out);
}
namespace avx512 {
void ContractLobes(const uint32_t* nodes, int count, const float* g,
                   const float* fields, int stride, float* out);
}

}  // namespace ibrdf
