#include "ibrdf/solvers/baselines/table_cost.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ibrdf {

TableCost::TableCost(const std::vector<TableSample>& samples,
                     std::pair<int, int> channels, int num_parameters,
                     TableModel model)
    : samples_(samples), channels_(channels), model_(std::move(model)) {
  CHECK_LE(0, channels.first);
  CHECK_LT(channels.first, channels.second);
  CHECK_LE(channels.second, 3);
  set_num_residuals(static_cast<int>(samples.size()) *
                    (channels.second - channels.first));
  mutable_parameter_block_sizes()->push_back(num_parameters);
}

bool TableCost::Evaluate(double const* const* parameters, double* residuals,
                         double** jacobians) const {
  const int n = parameter_block_sizes()[0];
  double* row =
      jacobians != nullptr && jacobians[0] != nullptr ? jacobians[0] : nullptr;
  int at = 0;
  for (size_t i = 0; i < samples_.size(); ++i) {
    const double root = std::sqrt(samples_[i].weight);
    for (int c = channels_.first; c < channels_.second; ++c, ++at) {
      const double f = model_(parameters[0], i, c, row);
      const double floor = kTableLogFloor * kMerlScale[c];
      residuals[at] = root * (std::log((f + floor) / kMerlScale[c]) -
                              samples_[i].log_raw[c]);
      if (!std::isfinite(residuals[at])) return false;  // step rejected
      if (row == nullptr) continue;
      for (int k = 0; k < n; ++k) {
        row[k] *= root / (f + floor);
        if (!std::isfinite(row[k])) return false;
      }
      row += n;
    }
  }
  return true;
}

double SolveTableFit(TableCost* cost,
                     const std::vector<ParameterBounds>& bounds,
                     const TableSolverOptions& options,
                     std::vector<double>* parameters) {
  CHECK_EQ(bounds.size(), parameters->size());
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  std::vector<double> p = *parameters;
  for (size_t i = 0; i < p.size(); ++i) {
    p[i] = std::clamp(p[i], bounds[i].lower, bounds[i].upper);
  }
  problem.AddResidualBlock(cost, nullptr, p.data());
  for (size_t i = 0; i < p.size(); ++i) {
    const int k = static_cast<int>(i);
    problem.SetParameterLowerBound(p.data(), k, bounds[i].lower);
    problem.SetParameterUpperBound(p.data(), k, bounds[i].upper);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.tolerance;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  VLOG(1) << summary.BriefReport();
  if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost)) {
    return std::numeric_limits<double>::infinity();
  }
  *parameters = p;
  return summary.final_cost;
}

}  // namespace ibrdf
