// Matrix-free Gauss-Newton with damping over the free blocks.
#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "ibrdf/solvers/joint/method_run.h"
#include "ibrdf/solvers/optim/conditioning.h"
#include "ibrdf/solvers/optim/conjugate_gradients.h"

namespace ibrdf {
namespace {

// Damping of the lobes, of their Hessian's diagonal where that of the light is
// 1: few parameters, whose trust region may start wide.
constexpr double kLobeDamping = 0.1;

// The damped system (H + damping D) at the objective's point: D the priors'
// inverse variances in the light, a share of H's diagonal in the lobes.
class DampedSystem {
 public:
  DampedSystem(JointObjective* objective, double damping)
      : objective_(objective),
        lobes_(objective->num_lobe_parameters()),
        metric_(objective->InverseVariance()),
        damping_diagonal_(damping * metric_) {
    if (lobes_ == 0) return;
    Eigen::MatrixXd H = objective->LobeHessian();
    damping_diagonal_.head(lobes_) = damping * kLobeDamping * H.diagonal();
    H.diagonal() += damping_diagonal_.head(lobes_);
    lobe_factor_.compute(H);
  }

  Eigen::VectorXd Product(const Eigen::VectorXd& v) const {
    Eigen::VectorXd product = objective_->Product(v);
    product.array() += damping_diagonal_.array() * v.array();
    return product;
  }
  // The preconditioner's inverse: lobes exactly, light by its prior variances.
  Eigen::VectorXd Precondition(const Eigen::VectorXd& r) const {
    Eigen::VectorXd z = r.array() / metric_.array();
    if (lobes_ > 0) z.head(lobes_) = lobe_factor_.solve(r.head(lobes_));
    return z;
  }

 private:
  JointObjective* objective_;
  const int lobes_;
  const Eigen::VectorXd metric_;
  Eigen::VectorXd damping_diagonal_;
  Eigen::LLT<Eigen::MatrixXd> lobe_factor_;
};

}  // namespace

void GaussNewtonSteps(MethodRun* run, int max_iterations, bool report) {
  JointObjective* objective = run->objective();
  const JointMethodOptions& options = run->options();
  double damping = 1.0;
  bool linearised = false;
  for (int k = 0; k < max_iterations; ++k) {
    if (run->Stop()) return;
    const double before = run->best_cost().total();
    if (!linearised) {
      if (!std::isfinite(objective->Linearise(run->best()).total())) return;
      linearised = true;
    }
    const DampedSystem system(objective, damping);
    CgCoefficients coefficients;
    const Eigen::VectorXd step = ConjugateGradients(
        [&](const Eigen::VectorXd& v) { return system.Product(v); },
        [&](const Eigen::VectorXd& r) { return system.Precondition(r); },
        -objective->gradient(), options.max_cg_iterations, options.cg_forcing,
        &coefficients);
    VLOG(1) << "Gauss-Newton step " << k + 1 << ": "
            << coefficients.alpha.size()
            << " conjugate gradients, condition of the damped and "
               "preconditioned system at least "
            << LanczosCondition(coefficients);
    // Along the step first (cheap: forward passes only), then shorter steps.
    bool accepted = false;
    for (double length = 1.0; length > 0.02; length *= 0.4) {
      const JointState candidate = objective->Moved(run->best(), step, length);
      const JointCost cost = objective->Evaluate(candidate);
      if (!(cost.total() < before)) continue;
      accepted = true;
      damping =
          std::clamp(length == 1.0 ? damping / 4 : damping * 2, 1e-4, 1e6);
      run->Offer(candidate, cost);
      break;
    }
    if (report) run->Report();
    if (!accepted) {
      damping *= 16;
      if (damping > 1e6) return;
      continue;
    }
    linearised = false;
    const double after = run->best_cost().total();
    if (before - after < options.tolerance * after) return;
  }
}

void RunGaussNewton(MethodRun* run) {
  GaussNewtonSteps(run, run->options().max_iterations, true);
}

}  // namespace ibrdf
