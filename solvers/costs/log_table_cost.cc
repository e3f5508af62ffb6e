#include "ibrdf/solvers/costs/log_table_cost.h"

#include <algorithm>
#include <cmath>

namespace ibrdf {

LogTableCost::LogTableCost(const BrdfFlow& flow, int code_size, double exponent,
                           int num_lobes, const TableColumns& table,
                           double floor, double weight, int num_threads)
    : flow_(flow),
      code_size_(code_size),
      num_lobes_(num_lobes),
      exponent_(exponent),
      table_(table),
      floor_(floor),
      scale_(std::sqrt(weight)),
      num_threads_(num_threads) {
  set_num_residuals(static_cast<int>(table.log_raw.size()));
  mutable_parameter_block_sizes()->push_back(num_lobes * (code_size + 3));
}

bool LogTableCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  const size_t n = table_.points.num_points();
  const int lobe_size = code_size_ + 3;
  const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
  std::vector<float> log_q(n * num_lobes_), dcode;
  if (derivatives) dcode.resize(n * num_lobes_ * code_size_);
  for (int k = 0; k < num_lobes_; ++k) {
    const double* z = parameters[0] + static_cast<size_t>(k) * lobe_size;
    const std::vector<float> code(z, z + code_size_);
    flow_.LogDensityOnColumns(
        table_.points, code.data(), num_threads_, log_q.data() + k * n,
        derivatives ? dcode.data() + k * n * code_size_ : nullptr);
  }
  std::vector<double> log_lobe(num_lobes_);
  for (int c = 0; c < 3; ++c) {
    for (size_t i = 0; i < n; ++i) {
      // log(sum exp + floor), by its largest term.
      double top = std::log(floor_);
      const double log_floor = top;
      for (int k = 0; k < num_lobes_; ++k) {
        log_lobe[k] = parameters[0][k * lobe_size + code_size_ + c] +
                      exponent_ * log_q[k * n + i];
        top = std::max(top, log_lobe[k]);
      }
      double sum = std::exp(log_floor - top);
      for (int k = 0; k < num_lobes_; ++k) sum += std::exp(log_lobe[k] - top);
      const double log_f = std::log(sum) + top;
      if (!std::isfinite(log_f)) return false;
      const size_t row = c * n + i;
      residuals[row] = scale_ * (log_f - table_.log_raw[row]);
      if (!derivatives) continue;
      double* j = jacobians[0] + row * num_lobes_ * lobe_size;
      for (int k = 0; k < num_lobes_; ++k, j += lobe_size) {
        const double share = scale_ * std::exp(log_lobe[k] - log_f);
        const float* dz = dcode.data() + k * n * code_size_ + i;
        for (int d = 0; d < code_size_; ++d) {
          j[d] = share * exponent_ * dz[d * n];
        }
        for (int b = 0; b < 3; ++b) j[code_size_ + b] = b == c ? share : 0.0;
      }
    }
  }
  return true;
}

}  // namespace ibrdf
