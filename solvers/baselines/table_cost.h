// Cost of an analytic BRDF against samples of a MERL table.
#pragma once
#include <ceres/cost_function.h>

#include <functional>
#include <utility>
#include <vector>

#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/solvers/baselines/table_samples.h"

namespace ibrdf {

// f of channel c at a sample, 1/sr and >= 0, and where `gradient` is not null
// df/dparameters.
using TableModel = std::function<double(const double* parameters, size_t sample,
                                        int channel, double* gradient)>;

// One residual per sample i and channel c:
//   r = sqrt(weight_i) (log(f / scale_c + floor) - log_raw_ic),
// in raw units of MERL with the floor of the metric. Half the squared norm over
// the three channels is 3/2 the squared log-RMSE over the samples.
class TableCost final : public ceres::CostFunction {
 public:
  // channels: first and one past the last. `samples` is not copied and must
  // outlive *this.
  TableCost(const std::vector<TableSample>& samples,
            std::pair<int, int> channels, int num_parameters, TableModel model);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const std::vector<TableSample>& samples_;
  const std::pair<int, int> channels_;
  const TableModel model_;
};

// Bounds of one parameter of a fit.
struct ParameterBounds {
  double lower, upper;
};

struct TableSolverOptions {
  int max_iterations = 60;
  double tolerance = 1e-6;  // relative decrease of the cost to stop at
};

// Levenberg-Marquardt within the bounds, one per parameter, from *parameters
// put into them. Returns the cost reached; infinite, with *parameters as they
// were, where the start has none.
double SolveTableFit(TableCost* cost,
                     const std::vector<ParameterBounds>& bounds,
                     const TableSolverOptions& options,
                     std::vector<double>* parameters);

}  // namespace ibrdf
