// The ambient term's prior as residuals.
#pragma once
#include <ceres/sized_cost_function.h>

#include "ibrdf/solvers/priors/ambient_prior.h"

namespace ibrdf {

// One block, the ambient term [3]; half the residuals' squares are
// AmbientPrior::Cost. The prior must be unknown().
class AmbientPriorCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  explicit AmbientPriorCost(const AmbientPrior& prior);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const AmbientPrior prior_;
};

}  // namespace ibrdf
