// Matrix-free Gauss-Newton with damping over the free blocks.
#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "ibrdf/solvers/joint/method_run.h"
#include "ibrdf/solvers/optim/conditioning.h"
#include "ibrdf/solvers/optim/conjugate_gradients.h"

namespace ibrdf {
namespace {

// Damping of the lobes, of their Hessian's diagonal where that of the light is
// 1: few parameters, whose trust region may start wide.
constexpr double kLobeDamping = 0.1;
// Share of the squared residual that conjugate gradients stop at where the
// light has a preconditioner. Without one they take a hundred steps to it.
constexpr double kPreconditionedForcing = 1e-3;

// The damped system (H + damping D) at the objective's point: D the priors'
// inverse variances in the light, a share of H's diagonal in the lobes.
class DampedSystem {
 public:
  // light: of the objective's point; null: none.
  DampedSystem(JointObjective* objective, LightPreconditioner* light,
               double damping)
      : objective_(objective),
        light_(light),
        lobes_(objective->num_lobe_parameters()),
        metric_(objective->InverseVariance()),
        damping_diagonal_(damping * metric_) {
    if (light_ != nullptr) light_->Damp(damping);
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
  // The preconditioner's inverse: lobes exactly, light by its preconditioner or
  // its prior variances.
  Eigen::VectorXd Precondition(const Eigen::VectorXd& r) const {
    Eigen::VectorXd z = r.array() / metric_.array();
    if (light_ != nullptr) light_->Apply(r.data() + lobes_, z.data() + lobes_);
    if (lobes_ > 0) z.head(lobes_) = lobe_factor_.solve(r.head(lobes_));
    return z;
  }

 private:
  JointObjective* objective_;
  LightPreconditioner* light_;
  const int lobes_;
  const Eigen::VectorXd metric_;
  Eigen::VectorXd damping_diagonal_;
  Eigen::LLT<Eigen::MatrixXd> lobe_factor_;
};

}  // namespace

void GaussNewtonSteps(MethodRun* run, int max_iterations, bool report) {
  JointObjective* objective = run->objective();
  const JointMethodOptions& options = run->options();
  std::unique_ptr<LightPreconditioner> light;
  double damping = 1.0;
  bool linearised = false;
  for (int k = 0; k < max_iterations; ++k) {
    if (run->Stop()) return;
    const double before = run->best_cost().total();
    if (!linearised) {
      if (!std::isfinite(objective->Linearise(run->best()).total())) return;
      linearised = true;
      if (options.precondition_light) {
        light = objective->PreconditionerOfLight();
      }
    }
    const DampedSystem system(objective, light.get(), damping);
    CgCoefficients coefficients;
    const Eigen::VectorXd step = ConjugateGradients(
        [&](const Eigen::VectorXd& v) { return system.Product(v); },
        [&](const Eigen::VectorXd& r) { return system.Precondition(r); },
        -objective->gradient(), options.max_cg_iterations,
        light == nullptr ? options.cg_forcing
                         : std::min(options.cg_forcing, kPreconditionedForcing),
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
