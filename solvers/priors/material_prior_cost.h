// The materials' prior as residuals.
#pragma once
#include <ceres/cost_function.h>

#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// One block, lobe parameters as LobeModel. Residuals: factor^-1 (x - mean),
// then per code wall * max(0, |z_k| - 1); half their squares are
// MaterialPrior::Cost.
class MaterialPriorCost final : public ceres::CostFunction {
 public:
  // prior must outlive *this.
  explicit MaterialPriorCost(const MaterialPrior* prior);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const MaterialPrior* prior_;
};

}  // namespace ibrdf
