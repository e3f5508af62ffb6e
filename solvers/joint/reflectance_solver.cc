#include "ibrdf/solvers/joint/reflectance_solver.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/Dense>

#include "ibrdf/solvers/optim/conditioning.h"
#include "ibrdf/solvers/optim/stop_callback.h"
#include "ibrdf/solvers/priors/ambient_prior_cost.h"
#include "ibrdf/solvers/priors/material_prior_cost.h"

namespace ibrdf {
namespace {

// Logs the conditioning of the problem's normal equations, J^T J, at its
// parameters' values.
void LogConditioning(ceres::Problem* problem, double cost) {
  ceres::CRSMatrix jacobian;
  if (!problem->Evaluate({}, nullptr, nullptr, nullptr, &jacobian)) return;
  Eigen::MatrixXd J =
      Eigen::MatrixXd::Zero(jacobian.num_rows, jacobian.num_cols);
  for (int row = 0; row < jacobian.num_rows; ++row) {
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
      J(row, jacobian.cols[i]) = jacobian.values[i];
    }
  }
  VLOG(1) << "reflectance: cost " << cost
          << ", condition of the normal equations, columns scaled, "
          << ScaledCondition(J.transpose() * J);
}

}  // namespace

double SolveReflectance(const Transport& transport, const LobeModel& lobes,
                        const std::vector<float>& map,
                        const Observations& observed,
                        const ReflectanceStepOptions& options,
                        std::vector<double>* parameters,
                        Eigen::Array3d* ambient) {
  const bool ambient_unknown = options.ambient != nullptr;
  CHECK(!ambient_unknown || ambient != nullptr);
  ceres::Problem problem;
  std::vector<double*> blocks = {parameters->data()};
  if (ambient_unknown) blocks.push_back(ambient->data());
  problem.AddResidualBlock(
      new LobeRadianceCost(&transport, &lobes, map, &observed,
                           options.likelihood, options.stored, ambient_unknown),
      nullptr, blocks);
  if (ambient_unknown) {
    for (int c = 0; c < 3; ++c) {
      problem.SetParameterLowerBound(ambient->data(), c, 0.0);
    }
    problem.AddResidualBlock(new AmbientPriorCost(*options.ambient), nullptr,
                             ambient->data());
  }
  ceres::CostFunction* const prior =
      options.materials != nullptr
          ? static_cast<ceres::CostFunction*>(
                new MaterialPriorCost(options.materials))
          : new LobePriorCost(lobes.layout(), options.prior);
  problem.AddResidualBlock(prior, nullptr, parameters->data());
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_QR;
  o.initial_trust_region_radius = options.trust_region_radius;
  o.max_num_iterations = options.max_iterations;
  o.function_tolerance = options.tolerance;
  o.logging_type = ceres::SILENT;
  StopCallback stop(options.should_stop);
  o.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(o, &problem, &summary);
  if (VLOG_IS_ON(1)) LogConditioning(&problem, summary.final_cost);
  return summary.final_cost;
}

}  // namespace ibrdf
