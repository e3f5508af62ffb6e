// One block at a time: Gauss-Newton on the light, then Ceres' trust region on
// the lobes.
#include "ibrdf/solvers/joint/method_run.h"
#include "ibrdf/solvers/joint/reflectance_solver.h"

namespace ibrdf {
namespace {

void LobeSteps(MethodRun* run) {
  JointObjective* objective = run->objective();
  const JointTerms& terms = objective->terms();
  ReflectanceStepOptions options;
  options.likelihood = terms.likelihood;
  options.prior = terms.lobe_prior;
  options.max_iterations = run->options().lobe_iterations;
  options.tolerance = run->options().tolerance;
  options.should_stop = [run] { return run->Stop(); };
  JointState state = run->best();
  SolveReflectance(*terms.transport, *terms.lobes, objective->MapOf(state),
                   *terms.observed, options, &state.lobes);
  run->Offer(state, objective->Evaluate(state));
}

}  // namespace

void RunAlternating(MethodRun* run) {
  JointObjective* objective = run->objective();
  const JointMethodOptions& options = run->options();
  const JointBlocks blocks = objective->free_blocks();
  const bool lobes = objective->num_lobe_parameters() > 0;
  const bool light = objective->num_light_parameters() > 0;
  for (int round = 0; round < options.max_iterations; ++round) {
    if (run->Stop()) break;
    const double before = run->best_cost().total();
    if (light) {
      objective->Free(JointBlocks::kLight);
      GaussNewtonSteps(run, options.light_iterations, false);
      objective->Free(blocks);
    }
    if (lobes && !run->Stop()) LobeSteps(run);
    run->Report();
    const double after = run->best_cost().total();
    if (!(before - after >= options.tolerance * after) || after == before) {
      break;
    }
  }
}

}  // namespace ibrdf
