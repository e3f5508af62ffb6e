// What one core of this machine can do at most, measured: the two lines of a
// roofline.
#pragma once
#include <cstddef>
#include <cstdint>

#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {

// Multiplies and adds of independent registers, `rounds` times; returns the
// number of floating-point operations. portable: SSE without fused operations.
int64_t MultiplyAdds(SimdLevel level, int64_t rounds);

// Reads and writes `count` floats; returns the bytes moved.
int64_t Stream(float* values, size_t count);

}  // namespace ibrdf
