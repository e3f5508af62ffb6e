#include "ibrdf/uncertainty/reflection_filter.h"

#include <glog/logging.h>

#include <cmath>

namespace ibrdf {

double FilterOf(GlossFilter filter, double alpha, int l) {
  DCHECK(alpha >= 0.0 && l >= 0);
  const double x = alpha * l;
  if (filter == GlossFilter::kBeckmann) return std::exp(-x * x);
  return x > 0.0 ? 2.0 * x * std::cyl_bessel_k(1.0, 2.0 * x) : 1.0;
}

std::vector<double> UnitValues(int count) {
  CHECK_GE(count, 2);
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(double(i) / (count - 1));
  return out;
}

std::vector<double> AlphaValues(AlphaGrid grid, int count) {
  std::vector<double> out = UnitValues(count);
  if (grid == AlphaGrid::kUniformRoughness) {
    for (double& alpha : out) alpha *= alpha;
  }
  return out;
}

}  // namespace ibrdf
