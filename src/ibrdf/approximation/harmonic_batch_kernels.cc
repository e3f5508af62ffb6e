#include "ibrdf/base/simd.h"
// The recurrence needs the vectors above.
#include "ibrdf/approximation/harmonic_batch.h"
#include "ibrdf/approximation/harmonic_recurrence.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// The first `count` floats, zeros behind them.
Vf LoadFirst(const float* p, int count) {
  Vf v = {};
  std::memcpy(&v, p, sizeof(float) * count);
  return v;
}

}  // namespace

void EvaluateHarmonics(const HarmonicConstants& constants, const float* polar,
                       const float* zero, const float* side, int num_directions,
                       float* Y, int64_t stride) {
  const auto& [order, diagonal, up, down] = constants;
  int i = 0;
  for (; i + kLanes <= num_directions; i += kLanes) {
    float* const out = Y + i;
    EvaluateRecurrence(order, diagonal, up, down, Load(polar + i),
                       Load(zero + i), Load(side + i), [&](int harmonic, Vf y) {
                         Store(out + harmonic * stride, y);
                       });
  }
  if (i == num_directions) return;
  const int rest = num_directions - i;
  float* const out = Y + i;
  EvaluateRecurrence(order, diagonal, up, down, LoadFirst(polar + i, rest),
                     LoadFirst(zero + i, rest), LoadFirst(side + i, rest),
                     [&](int harmonic, Vf y) {
                       std::memcpy(out + harmonic * stride, &y,
                                   sizeof(float) * rest);
                     });
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
