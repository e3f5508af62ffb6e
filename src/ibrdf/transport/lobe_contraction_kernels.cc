#include "ibrdf/base/simd.h"
#include "ibrdf/transport/lobe_contraction.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// Nodes ahead: the fields are larger than the caches near the core.
constexpr int kPrefetch = 8;
// So many of these sums, three channels each fit in the registers.
constexpr int kMostVectors = kLanes >= 16 ? 4 : 2;

// kVectors vectors from `fields` on, at which a node has `stride` floats.
template <int kVectors>
void Contract(const uint32_t* nodes, int count, const float* g,
              const float* fields, int stride, float* out) {
  Vf sum[3][kVectors] = {};
  for (int i = 0; i < count; ++i) {
    const int ahead = i + kPrefetch < count ? i + kPrefetch : i;
    const float* next = fields + static_cast<int64_t>(nodes[ahead]) * stride;
    for (int v = 0; v < kVectors; v += 16 / kLanes) {
      __builtin_prefetch(next + v * kLanes);
    }
    const float* field = fields + static_cast<int64_t>(nodes[i]) * stride;
    const float* weight = g + static_cast<int64_t>(i) * 4;
    for (int v = 0; v < kVectors; ++v) {
      const Vf x = Load(field + v * kLanes);
      for (int c = 0; c < 3; ++c) sum[c][v] += x * weight[c];
    }
  }
  for (int v = 0; v < kVectors; ++v) {
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int c = 0; c < 3; ++c) {
        out[(v * kLanes + lane) * 3 + c] = sum[c][v][lane];
      }
    }
  }
}

template <int kVectors>
void ContractFrom(int k, const uint32_t* nodes, int count, const float* g,
                  const float* fields, int stride, float* out) {
  for (; k + kVectors * kLanes <= stride; k += kVectors * kLanes) {
    Contract<kVectors>(nodes, count, g, fields + k, stride, out + 3 * k);
  }
  if constexpr (kVectors > 1) {
    ContractFrom<kVectors - 1>(k, nodes, count, g, fields, stride, out);
  }
}

}  // namespace

void ContractLobes(const uint32_t* nodes, int count, const float* g,
                   const float* fields, int stride, float* out) {
  ContractFrom<kMostVectors>(0, nodes, count, g, fields, stride, out);
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
