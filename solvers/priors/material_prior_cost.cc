#include "ibrdf/solvers/priors/material_prior_cost.h"

#include <Eigen/Dense>
#include <algorithm>

#include "ibrdf/solvers/optim/dense_algebra.h"

namespace ibrdf {

MaterialPriorCost::MaterialPriorCost(const MaterialPrior* prior)
    : prior_(prior) {
  mutable_parameter_block_sizes()->push_back(prior->num_parameters());
  set_num_residuals(prior->num_parameters() + prior->num_lobes());
}

bool MaterialPriorCost::Evaluate(double const* const* parameters,
                                 double* residuals, double** jacobians) const {
  const Eigen::Index n = prior_->num_parameters(), lobes = prior_->num_lobes();
  const Eigen::Map<const Eigen::VectorXd> x(parameters[0], n);
  Eigen::Map<Eigen::VectorXd> r(residuals, n + lobes);
  const auto lower = prior_->factor.triangularView<Eigen::Lower>();
  r.head(n) = lower.solve(x - prior_->mean);
  double* const jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
  if (jacobian != nullptr) {
    Eigen::Map<RowMatrix> J(jacobian, n + lobes, n);
    J.setZero();
    J.topRows(n) = lower.solve(Eigen::MatrixXd::Identity(n, n));
  }
  const LobeLayout layout = prior_->layout();
  for (int k = 0; k < layout.num_lobes; ++k) {
    const auto z = LobeMixture(layout, parameters[0]).code(k);
    const double norm = z.norm();
    r[n + k] = prior_->wall * std::max(0.0, norm - 1.0);
    if (jacobian != nullptr && norm > 1.0) {
      MutableLobeMixture(layout, jacobian + (n + k) * n).code(k) =
          prior_->wall / norm * z;
    }
  }
  return true;
}

}  // namespace ibrdf
