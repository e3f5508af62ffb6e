#include "ibrdf/approximation/harmonic_batch.h"

#include <glog/logging.h>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {
namespace {

using EvaluateFunction = void (*)(const HarmonicConstants& constants,
                                  const float* polar, const float* zero,
                                  const float* side, int num_directions,
                                  float* Y, int64_t stride);

EvaluateFunction HarmonicKernel() {
#if defined(IBRDF_HAVE_X86_KERNELS)
  switch (ActiveSimdLevel()) {
    case SimdLevel::kAvx512:
      return avx512::EvaluateHarmonics;
    case SimdLevel::kAvx2:
      return avx2::EvaluateHarmonics;
    case SimdLevel::kPortable:
    case SimdLevel::kDouble:
      break;
  }
#endif
  return portable::EvaluateHarmonics;
}

std::vector<float> ToFloat(const std::vector<double>& v) {
  return std::vector<float>(v.begin(), v.end());
}

}  // namespace

HarmonicBatch::HarmonicBatch(int order) : order_(order) {
  const HarmonicBasis basis(order);
  diagonal_ = ToFloat(basis.diagonal());
  up_ = ToFloat(basis.up());
  down_ = ToFloat(basis.down());
}

void HarmonicBatch::Evaluate(const float* polar, const float* zero,
                             const float* side, int num_directions, float* Y,
                             int64_t stride) const {
  DCHECK_LE(num_directions, stride);
  const HarmonicConstants constants{order_, diagonal_.data(), up_.data(),
                                    down_.data()};
  HarmonicKernel()(constants, polar, zero, side, num_directions, Y, stride);
}

}  // namespace ibrdf
