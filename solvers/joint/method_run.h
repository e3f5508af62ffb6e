// What the methods of MinimiseJoint share: clock, stopping, progress and the
// best iterate. Internal.
#pragma once
#include "ibrdf/base/stopwatch.h"
#include "ibrdf/solvers/joint/joint_method.h"

namespace ibrdf {

class MethodRun {
 public:
  // Evaluates the start. `objective` and `options` must outlive *this.
  MethodRun(JointObjective* objective, const JointState& start,
            const JointMethodOptions& options);

  JointObjective* objective() const { return objective_; }
  const JointMethodOptions& options() const { return options_; }
  const JointState& best() const { return best_; }
  const JointCost& best_cost() const { return best_cost_; }
  const JointCost& start_cost() const { return start_cost_; }
  int iterations() const { return iterations_; }
  bool stopped() const { return stopped_; }
  double Seconds() const { return clock_.Seconds(); }

  // Whether to end now, by the clock or the caller's wish.
  bool Stop();
  // Keeps a state that was evaluated if it is the best so far.
  void Offer(const JointState& state, const JointCost& cost);
  // The end of an iteration.
  void Report();

 private:
  JointObjective* objective_;
  const JointMethodOptions& options_;
  const Stopwatch clock_;
  JointState best_;
  JointCost start_cost_, best_cost_;
  int iterations_ = 0;
  bool stopped_ = false;
};

// At most so many steps from run->best(), which they improve; with `report`
// each is an iteration.
void GaussNewtonSteps(MethodRun* run, int max_iterations, bool report);

void RunAlternating(MethodRun* run);
void RunGaussNewton(MethodRun* run);
void RunLbfgs(MethodRun* run);
void RunAdam(MethodRun* run);
void RunTrustRegion(MethodRun* run);

}  // namespace ibrdf
