#include "ibrdf/approximation/harmonic_batch.h"

#include <glog/logging.h>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/base/to_float.h"

namespace ibrdf {

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
  const auto kernel = IBRDF_ACTIVE_KERNEL(EvaluateHarmonics);
  kernel(constants, polar, zero, side, num_directions, Y, stride);
}

}  // namespace ibrdf
