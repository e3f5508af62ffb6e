#include "ibrdf/solvers/joint/joint_method.h"

#include <glog/logging.h>

#include "ibrdf/solvers/joint/method_run.h"

namespace ibrdf {

MethodRun::MethodRun(JointObjective* objective, const JointState& start,
                     const JointMethodOptions& options)
    : objective_(objective), options_(options), best_(start) {
  start_cost_ = best_cost_ = objective->Evaluate(start);
}

bool MethodRun::Stop() {
  stopped_ = stopped_ || Seconds() >= options_.seconds ||
             (options_.should_stop && options_.should_stop());
  return stopped_;
}

void MethodRun::Offer(const JointState& state, const JointCost& cost) {
  if (!(cost.total() < best_cost_.total())) return;
  best_ = state;
  best_cost_ = cost;
}

void MethodRun::Report() {
  ++iterations_;
  if (options_.callback) {
    options_.callback({iterations_, Seconds(), best_cost_});
  }
}

Status CheckJointMethod(JointMethod method, const JointObjective& objective) {
  return CheckJointMethod(method, objective.size(), objective.num_residuals());
}

Status CheckJointMethod(JointMethod method, int64_t unknowns,
                        int64_t residuals) {
  if (method != JointMethod::kTrustRegion) return OkStatus();
  const int64_t n = unknowns, rows = residuals;
  if (n <= kMaxTrustRegionParameters && n * rows <= kMaxTrustRegionEntries) {
    return OkStatus();
  }
  return InvalidInput(
      "solver.method",
      "trust_region holds a dense Jacobian and takes at most " +
          std::to_string(kMaxTrustRegionParameters) + " unknowns and " +
          std::to_string(kMaxTrustRegionEntries) + " entries, found " +
          std::to_string(n) + " unknowns and " + std::to_string(n * rows) +
          " entries; expected a smaller map or image, or gauss_newton");
}

JointSummary MinimiseJoint(JointMethod method, JointObjective* objective,
                           JointState* state,
                           const JointMethodOptions& options) {
  CHECK(CheckJointMethod(method, *objective).ok());
  MethodRun run(objective, *state, options);
  switch (method) {
    case JointMethod::kAlternating:
      RunAlternating(&run);
      break;
    case JointMethod::kGaussNewton:
      RunGaussNewton(&run);
      break;
    case JointMethod::kLbfgs:
      RunLbfgs(&run);
      break;
    case JointMethod::kAdam:
      RunAdam(&run);
      break;
    case JointMethod::kTrustRegion:
      RunTrustRegion(&run);
      break;
  }
  *state = run.best();
  return {run.start_cost(), run.best_cost(), run.iterations(), run.Seconds(),
          run.stopped()};
}

}  // namespace ibrdf
