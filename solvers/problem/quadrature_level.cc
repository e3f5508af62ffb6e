#include "ibrdf/solvers/problem/quadrature_level.h"

#include <cmath>

namespace ibrdf {

QuadratureOptions AtLevel(QuadratureOptions standard, QuadratureLevel level) {
  if (level == QuadratureLevel::kStandard) return standard;
  const double finer = level == QuadratureLevel::kFine ? 2.0 : 0.5;
  // Half-vectors go by the product of the two.
  const auto scaled = [&](int n) {
    return static_cast<int>(std::lround(std::sqrt(finer) * n));
  };
  standard.near_rings = scaled(standard.near_rings);
  standard.near_ring_samples = scaled(standard.near_ring_samples);
  standard.far_width = static_cast<int>(finer * standard.far_width);
  return standard;
}

}  // namespace ibrdf
