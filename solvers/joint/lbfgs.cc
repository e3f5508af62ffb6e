// Ceres' L-BFGS over the free blocks, whitened by the priors.
#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <cmath>

#include "ibrdf/solvers/joint/ceres_progress.h"
#include "ibrdf/solvers/joint/method_run.h"

namespace ibrdf {
namespace {

// x_i = parameter_i / its prior's standard deviation. Offers what it evaluates.
class WhitenedObjective final : public ceres::FirstOrderFunction {
 public:
  WhitenedObjective(MethodRun* run, const Eigen::VectorXd& std)
      : run_(run), start_(run->best()), std_(std) {}
  int NumParameters() const override { return static_cast<int>(std_.size()); }
  bool Evaluate(const double* x, double* cost,
                double* gradient) const override {
    const Eigen::Map<const Eigen::VectorXd> v(x, std_.size());
    JointObjective* objective = run_->objective();
    const JointState state =
        objective->FromVector(v.cwiseProduct(std_), start_);
    Eigen::VectorXd g;
    const JointCost c = gradient != nullptr ? objective->Gradient(state, &g)
                                            : objective->Evaluate(state);
    if (!std::isfinite(c.total())) return false;
    run_->Offer(state, c);
    *cost = c.total();
    if (gradient != nullptr) {
      Eigen::Map<Eigen::VectorXd>(gradient, std_.size()) = g.cwiseProduct(std_);
    }
    return true;
  }

 private:
  MethodRun* run_;
  const JointState start_;
  const Eigen::VectorXd std_;
};

}  // namespace

void RunLbfgs(MethodRun* run) {
  const JointMethodOptions& options = run->options();
  if (run->Stop()) return;
  const Eigen::VectorXd std =
      run->objective()->InverseVariance().cwiseSqrt().cwiseInverse();
  Eigen::VectorXd x =
      run->objective()->ToVector(run->best()).cwiseQuotient(std);
  const ceres::GradientProblem problem(new WhitenedObjective(run, std));
  ceres::GradientProblemSolver::Options o;
  o.line_search_direction_type = ceres::LBFGS;
  o.max_lbfgs_rank = 20;
  o.function_tolerance = options.tolerance / options.max_cg_iterations;
  o.parameter_tolerance = 0.0;
  o.logging_type = ceres::SILENT;
  CeresProgress progress(run);
  o.callbacks.push_back(&progress);
  const int most = options.max_iterations * options.max_cg_iterations;
  const int before = run->iterations();
  // At kinks of the likelihood and of a network's activations the directions
  // break down, and steps shrink to nothing. Without their memory they go on.
  for (double gain = 1.0; gain > options.tolerance && !run->Stop();) {
    o.max_num_iterations = most - (run->iterations() - before);
    if (o.max_num_iterations <= 0) break;
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(o, problem, x.data(), &summary);
    gain = (summary.initial_cost - summary.final_cost) / summary.initial_cost;
  }
}

}  // namespace ibrdf
