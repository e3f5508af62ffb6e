// Ceres' trust region on the dense Jacobian, compressed exactly.
#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "solvers/joint/ceres_progress.h"
#include "solvers/joint/method_run.h"

namespace ibrdf {
namespace {

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
  explicit CompressedCost(MethodRun* run) : run_(run), start_(run->best()) {
    const JointObjective& objective = *run->objective();
    for (const int n :
         {objective.num_lobe_parameters(), objective.num_light_parameters()}) {
      if (n > 0) mutable_parameter_block_sizes()->push_back(n);
    }
    set_num_residuals(objective.size() + 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    JointObjective* objective = run_->objective();
    Eigen::VectorXd x(objective->size());
    Eigen::Index at = 0;
    for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
      for (int i = 0; i < parameter_block_sizes()[b]; ++i) {
        x[at++] = parameters[b][i];
      }
    }
    const JointState state = objective->FromVector(x, start_);
    Eigen::Map<Eigen::VectorXd> r(residuals, num_residuals());
    r.setZero();
    const JointCost cost = jacobians == nullptr ? objective->Evaluate(state)
                                                : objective->Linearise(state);
    if (!std::isfinite(cost.total())) return false;
    run_->Offer(state, cost);
    if (jacobians == nullptr) {
      r[0] = std::sqrt(2.0 * cost.total());
      return true;
    }
    return Compress(cost, r, jacobians);
  }

 private:
  bool Compress(const JointCost& cost, Eigen::Map<Eigen::VectorXd> out,
                double** jacobians) const {
    JointObjective* objective = run_->objective();
    const Eigen::Index n = objective->size(), m = objective->num_residuals();
    Eigen::MatrixXd J(m + n, n), H(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, i);
      J.col(i).head(m) = objective->ResidualJvp(unit);
      H.col(i) = objective->PriorProduct(unit);
    }
    // Symmetric but for the rounding of float kernels.
    const Eigen::LLT<Eigen::MatrixXd> factor((H + H.transpose()) / 2);
    if (factor.info() != Eigen::Success) return false;
    J.bottomRows(n) = factor.matrixU();
    Eigen::VectorXd r(m + n);
    r.head(m) = Eigen::Map<const Eigen::VectorXd>(
        objective->residuals().data(), m);
    r.tail(n) = factor.matrixL().solve(objective->PriorGradient());

    Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(J);  // in place
    r.applyOnTheLeft(qr.householderQ().adjoint());
    out.head(n) = r.head(n);
    out[n] = std::sqrt(
        std::max(2.0 * cost.total() - r.head(n).squaredNorm(), 0.0));
    Eigen::Index first = 0;
    for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
      const Eigen::Index size = parameter_block_sizes()[b];
      if (jacobians[b] != nullptr) {
        Eigen::Map<RowMajorMatrix> block(jacobians[b], n + 1, size);
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

  MethodRun* run_;
  const JointState start_;
};

}  // namespace

void RunTrustRegion(MethodRun* run) {
  JointObjective* objective = run->objective();
  if (run->Stop()) return;
  Eigen::VectorXd x = objective->ToVector(run->best());
  std::vector<double*> blocks;
  if (objective->num_lobe_parameters() > 0) blocks.push_back(x.data());
  if (objective->num_light_parameters() > 0) {
    blocks.push_back(x.data() + objective->num_lobe_parameters());
  }
  ceres::Problem problem;
  problem.AddResidualBlock(new CompressedCost(run), nullptr, blocks);
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_QR;
  o.initial_trust_region_radius = 10.0;
  o.max_num_iterations = run->options().max_iterations;
  o.function_tolerance = run->options().tolerance;
  o.logging_type = ceres::SILENT;
  CeresProgress progress(run);
  o.callbacks.push_back(&progress);
  ceres::Solver::Summary summary;
  ceres::Solve(o, &problem, &summary);
}

}  // namespace ibrdf
