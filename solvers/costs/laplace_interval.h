// The probability that a Laplacian variable lies in an interval.
#pragma once
#include <algorithm>
#include <cmath>

namespace ibrdf {

// -log of the integral of exp(-|x - mean| / b) / (2 b) over [low, high], nats;
// >= 0. low <= high, -infinity and infinity where there is no end; b > 0. The
// interval is taken as 1e-9 b wide at least.
inline double LaplaceIntervalCost(double low, double high, double mean,
                                  double b) {
  const double from = (low - mean) / b;
  const double width = std::max((high - low) / b, 1e-9);
  const double to = std::isinf(from) ? (high - mean) / b : from + width;
  // Both ends on one side: half the density at the nearer one, times what of
  // its tail the width takes in.
  if (from > 0.0 || to < 0.0) {
    return std::max(from, -to) + std::log(2.0) - std::log(-std::expm1(-width));
  }
  return -std::log1p(-0.5 * (std::exp(from) + std::exp(-to)));
}

}  // namespace ibrdf
