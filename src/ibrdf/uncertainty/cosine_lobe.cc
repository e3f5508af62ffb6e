#include "ibrdf/uncertainty/cosine_lobe.h"

#include <cmath>

#include "ibrdf/base/gauss_legendre.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {

std::vector<double> CosineLobe(const HarmonicBasis& basis) {
  std::vector<double> nodes, weights, Y(basis.count()),
      out(basis.order() + 1, 0.0);
  GaussLegendre(16, &nodes, &weights);
  for (size_t k = 0; k < nodes.size(); ++k) {
    const double z = nodes[k];
    basis.Evaluate({0.0, z, std::sqrt(1.0 - z * z)}, Y.data());
    for (int l = 0; l <= basis.order(); ++l) {
      out[l] += 2.0 * kPi * weights[k] * z * Y[HarmonicIndex(l, 0)];
    }
  }
  return out;
}

}  // namespace ibrdf
