#include "ibrdf/solvers/priors/material_prior_cost.h"

#include <Eigen/Dense>
#include <algorithm>

#include "ibrdf/solvers/optim/dense_algebra.h"

namespace ibrdf {

MaterialPriorCost::MaterialPriorCost(const MaterialPrior* prior)
    : prior_(prior) {
  mutable_parameter_block_sizes()->push_back(prior->num_parameters());
  set_num_residuals(prior->num_parameters() + prior->layout().num_coded());
}

bool MaterialPriorCost::Evaluate(double const* const* parameters,
                                 double* residuals, double** jacobians) const {
  const LobeLayout layout = prior_->layout();
  const Eigen::Index n = prior_->num_parameters(), coded = layout.num_coded();
  const Eigen::Map<const Eigen::VectorXd> x(parameters[0], n);
  Eigen::Map<Eigen::VectorXd> r(residuals, n + coded);
  const auto lower = prior_->factor.triangularView<Eigen::Lower>();
  r.head(n) = lower.solve(x - prior_->mean);
  double* const jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
  if (jacobian != nullptr) {
    Eigen::Map<RowMatrix> J(jacobian, n + coded, n);
    J.setZero();
    J.topRows(n) = lower.solve(Eigen::MatrixXd::Identity(n, n));
  }
  for (int k = 0; k < layout.num_coded(); ++k) {
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
