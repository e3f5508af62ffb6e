#include "ibrdf/solvers/costs/log_likelihood.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

// L_o + epsilon counts as no less: its logarithm and the square of its inverse
// stay finite.
constexpr double kLeastRadiance = 1e-100;

}  // namespace

LikelihoodValue EvaluateLikelihood(const std::vector<double>& L_o,
                                   const Observations& observed,
                                   const RobustLogLikelihood& likelihood,
                                   LikelihoodDerivatives* derivatives) {
  CHECK_EQ(L_o.size(), observed.radiance.size());
  const RobustLogLikelihood& l = likelihood;
  if (derivatives != nullptr) {
    derivatives->residual.assign(L_o.size(), 0.0);
    derivatives->d_residual.assign(L_o.size(), 0.0);
    derivatives->weight.assign(L_o.size(), 0.0);
  }
  LikelihoodValue value;
  double counted = 0.0;  // in the misfit
  for (size_t i = 0; i < L_o.size(); ++i) {
    if (!observed.valid[i / 3]) continue;
    if (!std::isfinite(L_o[i])) {
      value.cost = value.misfit = std::numeric_limits<double>::quiet_NaN();
      return value;
    }
    const RadianceInterval interval = observed.Interval(i);
    const double radiance = std::max(L_o[i], 0.0) + l.ambient[i % 3];
    const bool holds = !interval.IsExact() && interval.Contains(radiance);
    if (holds) {
      counted += interval.IsOneSided() ? 0.0 : 1.0;
      continue;
    }
    counted += 1.0;
    const double sum = radiance + l.epsilon;
    const double e = std::max(sum, kLeastRadiance);
    const double d =
        std::log(e) - std::log(interval.Nearest(radiance) + l.epsilon);
    const double t = d / l.scale;
    double dr_dt = 0.0;
    const double r = RobustResidual(t, l.delta, &dr_dt);
    value.cost += r * r / 2;
    value.misfit += std::abs(d);
    if (derivatives == nullptr) continue;
    // No slope where L_o counts as another.
    const bool moves = L_o[i] >= 0.0 && sum >= kLeastRadiance;
    const double dt = moves ? 1.0 / (l.scale * e) : 0.0;
    derivatives->residual[i] = r;
    derivatives->d_residual[i] = dr_dt * dt;
    derivatives->weight[i] = dt * dt / std::hypot(t, l.delta);  // rho'(t) / t
  }
  value.misfit /= std::max(counted, 1.0);
  return value;
}

}  // namespace ibrdf
