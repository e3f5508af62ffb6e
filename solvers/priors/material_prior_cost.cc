#include "ibrdf/solvers/priors/material_prior_cost.h"

#include <Eigen/Dense>

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
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  double* const jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
  if (jacobian != nullptr) {
    Eigen::Map<RowMajor> J(jacobian, n + lobes, n);
    J.setZero();
    J.topRows(n) = lower.solve(Eigen::MatrixXd::Identity(n, n));
  }
  for (Eigen::Index k = 0; k < lobes; ++k) {
    const Eigen::Index first = k * (prior_->code_size + 3);
    const auto z = x.segment(first, prior_->code_size);
    const double norm = z.norm();
    r[n + k] = prior_->wall * std::max(0.0, norm - 1.0);
    if (jacobian != nullptr && norm > 1.0) {
      Eigen::Map<RowMajor>(jacobian, n + lobes, n)
          .row(n + k)
          .segment(first, prior_->code_size) =
          prior_->wall / norm * z.transpose();
    }
  }
  return true;
}

}  // namespace ibrdf
