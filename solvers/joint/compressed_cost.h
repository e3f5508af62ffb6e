// The joint objective as one small least-squares block for Ceres.
#pragma once
#include <ceres/cost_function.h>

#include <functional>

#include "ibrdf/solvers/joint/joint_objective.h"

namespace ibrdf {

// The whole objective as n + 1 residuals of the n unknowns, in the blocks
// [lobes] and [light] that are free. With r the likelihood's residuals above
// the priors', J = Q R their Jacobian,
//   residuals [Q^T r; |r - Q Q^T r|], Jacobian [R; 0]:
// the same cost, gradient and Gauss-Newton matrix, whatever the number of
// pixels. Without Jacobians only the norm is needed, and the first residual
// holds it all.
//
// The priors give cost c, gradient g and a matrix H = U^T U, and as
// g^T H^-1 g <= 2 c (see LightPrior) they are the residuals
// [U^-T g; sqrt(2 c - |U^-T g|^2)] with the Jacobian [U; 0].
class CompressedCost final : public ceres::CostFunction {
 public:
  using OnEvaluate = std::function<void(const JointState&, const JointCost&)>;

  // Blocks that are held stay as in `start`. `on_evaluate`, if not empty, sees
  // every state that is feasible. `objective` must outlive *this.
  CompressedCost(JointObjective* objective, const JointState& start,
                 OnEvaluate on_evaluate);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  bool Compress(const JointCost& cost, double* residuals,
                double** jacobians) const;

  JointObjective* objective_;
  const JointState start_;
  const OnEvaluate on_evaluate_;
};

}  // namespace ibrdf
