#include "ibrdf/transport/linear_transport.h"

#include <cstddef>

namespace ibrdf {

void LinearTransport::Apply(const float* map, double* L_o) const {
  ApplyLinear(map, L_o);
  for (size_t k = 0; k < offset_.size(); ++k) L_o[k] += offset_[k];
}

}  // namespace ibrdf
