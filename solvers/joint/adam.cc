// Adam, one block at a time on a fixed schedule (Chen et al. 2020): the
// reference that the other methods are measured against.
#include "ibrdf/solvers/optim/adam.h"

#include <cmath>

#include "ibrdf/solvers/joint/method_run.h"

namespace ibrdf {
namespace {

// The optimiser of one block; moments last from round to round.
class BlockAdam {
 public:
  BlockAdam(MethodRun* run, JointBlocks block, double rate)
      : run_(run), block_(block), rate_(rate) {}

  // False if the run is to end.
  bool Steps(int count, JointState* state) {
    JointObjective* objective = run_->objective();
    objective->Free(block_);
    if (adam_.mean.empty()) adam_ = Adam(objective->size());
    Eigen::VectorXd gradient;
    for (int k = 0; k < count; ++k) {
      if (run_->Stop()) return false;
      const JointCost cost = objective->Gradient(*state, &gradient);
      // A step that leaves the feasible numbers ends the block's turn.
      if (!std::isfinite(cost.total())) {
        *state = run_->best();
        return true;
      }
      run_->Offer(*state, cost);
      run_->Report();
      const Eigen::VectorXf g = gradient.cast<float>();
      Eigen::VectorXf step = Eigen::VectorXf::Zero(g.size());
      adam_.Step(g.data(), rate_, ++steps_, 0, g.size(), step.data());
      *state = objective->Moved(*state, step.cast<double>(), 1.0);
    }
    run_->Offer(*state, objective->Evaluate(*state));
    return true;
  }

 private:
  MethodRun* run_;
  const JointBlocks block_;
  const double rate_;
  Adam adam_;
  int64_t steps_ = 0;
};

}  // namespace

void RunAdam(MethodRun* run) {
  JointObjective* objective = run->objective();
  const JointMethodOptions& options = run->options();
  const JointBlocks blocks = objective->free_blocks();
  const bool lobes = objective->num_lobe_parameters() > 0;
  const bool light = objective->num_light_parameters() > 0;
  BlockAdam by_light(run, JointBlocks::kLight, options.adam_light_rate);
  BlockAdam by_lobes(run, JointBlocks::kLobes, options.adam_lobe_rate);
  JointState state = run->best();
  for (int round = 0; round < options.adam_rounds; ++round) {
    if (light && !by_light.Steps(options.adam_light_steps, &state)) break;
    if (lobes && !by_lobes.Steps(options.adam_lobe_steps, &state)) break;
  }
  objective->Free(blocks);
}

}  // namespace ibrdf
