#include "ibrdf/solvers/joint/compressed_cost.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

// Of the largest diagonal element.
constexpr double kFloatRounding = 1e-7, kLargestShift = 1e-3;

// H has float rounding, which may take the least of its eigenvalues below 0. It
// is factorised with the least of a few multiples of the identity that mends
// this. False: none does, or H is not finite.
bool FactoriseNearly(Eigen::MatrixXd H, Eigen::LLT<Eigen::MatrixXd>* factor) {
  if (!H.allFinite()) return false;
  factor->compute(H);
  const double largest = H.diagonal().maxCoeff();
  for (double shift = kFloatRounding;
       factor->info() != Eigen::Success && shift <= kLargestShift;
       shift *= 10.0) {
    H.diagonal().array() += shift * largest;
    factor->compute(H);
  }
  return factor->info() == Eigen::Success;
}

}  // namespace

CompressedCost::CompressedCost(JointObjective* objective,
                               const JointState& start, OnEvaluate on_evaluate)
    : objective_(objective),
      start_(start),
      on_evaluate_(std::move(on_evaluate)) {
  for (const int n :
       {objective->num_lobe_parameters(), objective->num_light_parameters()}) {
    if (n > 0) mutable_parameter_block_sizes()->push_back(n);
  }
  set_num_residuals(objective->size() + 1);
}

bool CompressedCost::Evaluate(double const* const* parameters,
                              double* residuals, double** jacobians) const {
  Eigen::VectorXd x(objective_->size());
  Eigen::Index at = 0;
  for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
    for (int i = 0; i < parameter_block_sizes()[b]; ++i) {
      x[at++] = parameters[b][i];
    }
  }
  const JointState state = objective_->FromVector(x, start_);
  Eigen::Map<Eigen::VectorXd> r(residuals, num_residuals());
  r.setZero();
  const JointCost cost = jacobians == nullptr ? objective_->Evaluate(state)
                                              : objective_->Linearise(state);
  if (!std::isfinite(cost.total())) return false;
  if (on_evaluate_) on_evaluate_(state, cost);
  if (jacobians == nullptr) {
    r[0] = std::sqrt(2.0 * cost.total());
    return true;
  }
  return Compress(cost, residuals, jacobians);
}

bool CompressedCost::Compress(const JointCost& cost, double* residuals,
                              double** jacobians) const {
  const Eigen::Index n = objective_->size(), m = objective_->num_residuals();
  Eigen::MatrixXd J(m + n, n), H(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, i);
    J.col(i).head(m) = objective_->ResidualJvp(unit);
    H.col(i) = objective_->PriorProduct(unit);
  }
  // Symmetric but for the rounding of float kernels.
  Eigen::LLT<Eigen::MatrixXd> factor;
  if (!FactoriseNearly((H + H.transpose()) / 2, &factor)) return false;
  J.bottomRows(n) = factor.matrixU();
  Eigen::VectorXd r(m + n);
  r.head(m) =
      Eigen::Map<const Eigen::VectorXd>(objective_->residuals().data(), m);
  r.tail(n) = factor.matrixL().solve(objective_->PriorGradient());

  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(J);  // in place
  r.applyOnTheLeft(qr.householderQ().adjoint());
  Eigen::Map<Eigen::VectorXd> out(residuals, n + 1);
  out.head(n) = r.head(n);
  out[n] =
      std::sqrt(std::max(2.0 * cost.total() - r.head(n).squaredNorm(), 0.0));
  Eigen::Index first = 0;
  for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
    const Eigen::Index size = parameter_block_sizes()[b];
    if (jacobians[b] != nullptr) {
      Eigen::Map<RowMatrix> block(jacobians[b], n + 1, size);
      block.setZero();
      for (Eigen::Index i = 0; i < size; ++i) {
        const Eigen::Index column = first + i;
        block.col(i).head(column + 1) = J.col(column).head(column + 1);
      }
    }
    first += size;
  }
  return true;
}

}  // namespace ibrdf
