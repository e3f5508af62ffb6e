#include "ibrdf/transport/lobe_contraction.h"

#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {

ContractLobesFunction ContractLobes() {
#if defined(IBRDF_HAVE_X86_KERNELS)
  switch (ActiveSimdLevel()) {
    case SimdLevel::kAvx512:
      return avx512::ContractLobes;
    case SimdLevel::kAvx2:
      return avx2::ContractLobes;
    case SimdLevel::kPortable:
    case SimdLevel::kDouble:
      break;
  }
#endif
  return portable::ContractLobes;
}

}  // namespace ibrdf
