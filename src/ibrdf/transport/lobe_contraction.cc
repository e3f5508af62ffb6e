#include "ibrdf/transport/lobe_contraction.h"

#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {

ContractLobesFunction ContractLobes() {
  return IBRDF_ACTIVE_KERNEL(ContractLobes);
}

}  // namespace ibrdf
