#include "ibrdf/base/simd_dispatch.h"

#include <cstdlib>
#include <string>

namespace ibrdf {

bool SimdLevelSupported(SimdLevel level) {
#if defined(IBRDF_HAVE_X86_KERNELS)
  switch (level) {
    case SimdLevel::kPortable:
    case SimdLevel::kDouble:
      return true;
    case SimdLevel::kAvx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case SimdLevel::kAvx512:
      return __builtin_cpu_supports("avx512f") &&
             __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("fma");
  }
  return false;
#else
  return level == SimdLevel::kPortable || level == SimdLevel::kDouble;
#endif
}

const char* SimdLevelName(SimdLevel level) {
  switch (level) {
    case SimdLevel::kPortable:
      return "portable";
    case SimdLevel::kAvx2:
      return "avx2";
    case SimdLevel::kAvx512:
      return "avx512";
    case SimdLevel::kDouble:
      return "double";
  }
  return "unknown";
}

SimdLevel ActiveSimdLevel() {
  static const SimdLevel level = [] {
    const char* wanted = std::getenv("IBRDF_SIMD");
    if (wanted != nullptr &&
        std::string(wanted) == SimdLevelName(SimdLevel::kDouble)) {
      return SimdLevel::kDouble;
    }
    for (const SimdLevel candidate :
         {SimdLevel::kAvx512, SimdLevel::kAvx2, SimdLevel::kPortable}) {
      if (!SimdLevelSupported(candidate)) continue;
      if (wanted == nullptr || std::string(wanted) == SimdLevelName(candidate))
        return candidate;
    }
    return SimdLevel::kPortable;
  }();
  return level;
}

}  // namespace ibrdf
