// The image likelihood of rendered radiance, with the derivatives that every
// solver takes.
#pragma once
#include <vector>

#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/costs/robust_log_residual.h"

namespace ibrdf {

// Per value of L_o, 0 where the point takes no part:
//   residual_i = RobustResidual((log(L_o_i + a + eps) - log(I_i + eps)) / b),
// a the ambient term of the point's channel, I the observed radiance, of an
// interval the value in it nearest to L_o + a, so that sum residual^2 / 2 is
// the likelihood. Negative L_o counts as 0, and 0 without epsilon as 1e-100,
// both without slope.
struct LikelihoodDerivatives {
  std::vector<double> residual;
  std::vector<double> d_residual;  // d residual / dL_o, and by the ambient term
  // Weights of the iteratively reweighted squares that touch the likelihood at
  // L_o with its slope: sum weight_i dL_o_i^2 / 2 has the curvature of a
  // Gauss-Newton step.
  std::vector<double> weight;
};

struct LikelihoodValue {
  double cost = 0.0;  // nats; NaN where L_o is not finite
  // Mean |log L_o - log I|; 0 without points. One end alone that holds says
  // nothing of how well the image is met, and does not count.
  double misfit = 0.0;
};

// L_o [points * 3]; derivatives may be null.
LikelihoodValue EvaluateLikelihood(const std::vector<double>& L_o,
                                   const Observations& observed,
                                   const RobustLogLikelihood& likelihood,
                                   LikelihoodDerivatives* derivatives);

}  // namespace ibrdf
