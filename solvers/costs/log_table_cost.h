// Cost of coloured lobes against a measured table, in log space.
#pragma once
#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {

// What a fit sees of a table: some columns of constant (theta_d, phi_d), some
// theta_h in each.
struct TableColumns {
  FlowColumns points;
  // log(raw + floor) [3][points.num_points()]; minus infinity where nothing was
  // measured, which costs nothing.
  std::vector<float> log_raw;
};

// Parameters as LobeModel's. Residuals per channel and point:
// log(sum_k exp(a_kc) q(x | z_k)^exponent + floor) - log raw, raw units, times
// sqrt(weight); of a Lambertian lobe q is 1. Where another lobe dominates, a
// lobe's derivative vanishes
// smoothly; where all are below the floor, all do.
class LogTableCost final : public ceres::CostFunction {
 public:
  // flow and table must outlive *this.
  LogTableCost(const BrdfFlow& flow, const LobeLayout& layout, double exponent,
               const TableColumns& table, double floor, double weight,
               int num_threads);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const BrdfFlow& flow_;
  const LobeLayout layout_;
  const double exponent_;
  const TableColumns& table_;
  const double floor_, scale_;
  const int num_threads_;
};

}  // namespace ibrdf
