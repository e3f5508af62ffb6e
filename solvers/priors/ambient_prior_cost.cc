#include "ibrdf/solvers/priors/ambient_prior_cost.h"

#include <glog/logging.h>

#include <algorithm>

namespace ibrdf {

AmbientPriorCost::AmbientPriorCost(const AmbientPrior& prior) : prior_(prior) {
  CHECK(prior.unknown());
}

bool AmbientPriorCost::Evaluate(double const* const* parameters,
                                double* residuals, double** jacobians) const {
  const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
  if (wanted) std::fill_n(jacobians[0], 9, 0.0);
  for (int c = 0; c < 3; ++c) {
    residuals[c] = (parameters[0][c] - prior_.mean[c]) / prior_.deviation[c];
    if (wanted) jacobians[0][4 * c] = 1.0 / prior_.deviation[c];
  }
  return true;
}

}  // namespace ibrdf
