#include "ibrdf/base/simd.h"
#include "ibrdf/render/lobe_contraction.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {

void ContractLobes(const uint32_t* nodes, int count, const float* g,
                   const float* fields, int stride, float* out) {
  for (int k = 0; k < stride; k += kLobeStride) {
    constexpr int kVectors = kLobeStride / kLanes;
    Vf sum[3][kVectors] = {};
    for (int i = 0; i < count; ++i) {
      const float* field = fields + static_cast<int64_t>(nodes[i]) * stride + k;
      const float* weight = g + static_cast<int64_t>(i) * 4;
      for (int v = 0; v < kVectors; ++v) {
        const Vf x = Load(field + v * kLanes);
        for (int c = 0; c < 3; ++c) sum[c][v] += x * weight[c];
      }
    }
    for (int v = 0; v < kVectors; ++v) {
      for (int lane = 0; lane < kLanes; ++lane) {
        for (int c = 0; c < 3; ++c) {
          out[(k + v * kLanes + lane) * 3 + c] = sum[c][v][lane];
        }
      }
    }
  }
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
