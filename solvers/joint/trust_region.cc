// Ceres' trust region on the dense Jacobian, compressed exactly.
#include <ceres/ceres.h>

#include "ibrdf/solvers/joint/ceres_progress.h"
#include "ibrdf/solvers/joint/compressed_cost.h"
#include "ibrdf/solvers/joint/method_run.h"

namespace ibrdf {

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
  problem.AddResidualBlock(
      new CompressedCost(objective, run->best(),
                         [run](const JointState& state, const JointCost& cost) {
                           run->Offer(state, cost);
                         }),
      nullptr, blocks);
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
