#include "ibrdf/solvers/costs/interval_likelihood.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/gauss_legendre.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// Nodes of the quadrature. The error is below that of double where the density
// falls by kDecay from its peak to an end.
constexpr int kNodes = 40;
constexpr double kDecay = 40.0;  // nats
constexpr double kLeastWidth = 1e-9;

struct Rule {
  std::vector<double> nodes, weights;  // on [0, 1]
  Rule() { GaussLegendre(kNodes, &nodes, &weights); }
};

const Rule& TheRule() {
  static const Rule rule;
  return rule;
}

// Integral and moments of exp(-peak u - u^2 / 2), u from the peak.
struct Moments {
  double integral = 0.0, mean = 0.0, variance = 0.0, third = 0.0;
};

Moments MomentsFrom(double peak, double from, double to) {
  const Rule& rule = TheRule();
  const double width = to - from;
  double density[kNodes];
  Moments m;
  for (int k = 0; k < kNodes; ++k) {
    const double u = from + width * rule.nodes[k];
    density[k] = rule.weights[k] * std::exp(-u * (peak + 0.5 * u));
    m.integral += density[k];
    m.mean += density[k] * u;
  }
  m.mean /= m.integral;
  for (int k = 0; k < kNodes; ++k) {
    const double d = from + width * rule.nodes[k] - m.mean;
    m.variance += density[k] * d * d;
    m.third += density[k] * d * d * d;
  }
  m.variance /= m.integral;
  m.third /= m.integral;
  m.integral *= width;
  return m;
}

}  // namespace

IntervalLikelihood EvaluateInterval(double low, double high, double mean,
                                    double deviation) {
  IntervalLikelihood out;
  if (std::isinf(low) && std::isinf(high)) return out;
  const double s = deviation;
  const double a = (low - mean) / s;
  const double width = std::max((high - low) / s, kLeastWidth);
  const double b = std::isinf(a) ? (high - mean) / s : a + width;
  // The most probable standardised value, the ends as seen from there, and the
  // way on which the density falls by kDecay.
  const double peak = std::min(std::max(0.0, a), b);
  const double to_low = b < 0.0 ? -width : a - peak;
  const double to_high = peak > 0.0 ? width : b - peak;
  const double reach = 2.0 * kDecay / (std::abs(peak) +
                                       std::hypot(peak, std::sqrt(2 * kDecay)));
  const Moments m = MomentsFrom(peak, std::max(to_low, -reach),
                                std::min(to_high, reach));
  out.cost = 0.5 * peak * peak + 0.5 * std::log(2.0 * kPi) -
             std::log(m.integral);
  out.slope = (peak + m.mean) / s;
  out.curvature = std::max(1.0 - m.variance, 0.0) / (s * s);
  out.third = -m.third / (s * s * s);
  return out;
}

}  // namespace ibrdf
