#include "ibrdf/solvers/costs/log_table_cost.h"

#include <algorithm>
#include <cmath>

namespace ibrdf {

LogTableCost::LogTableCost(const BrdfFlow& flow, const LobeLayout& layout,
                           double exponent, const TableColumns& table,
                           double floor, double weight, int num_threads)
    : flow_(flow),
      layout_(layout),
      exponent_(exponent),
      table_(table),
      floor_(floor),
      scale_(std::sqrt(weight)),
      num_threads_(num_threads) {
  set_num_residuals(static_cast<int>(table.log_raw.size()));
  mutable_parameter_block_sizes()->push_back(layout_.num_parameters());
}

bool LogTableCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  const size_t n = table_.points.num_points();
  const int num_lobes = layout_.num_lobes, code_size = layout_.code_size;
  const LobeMixture lobes(layout_, parameters[0]);
  const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
  std::vector<float> log_q(n * num_lobes, 0.0f), dcode;
  if (derivatives) dcode.resize(n * layout_.num_coded() * code_size);
  for (int k = 0; k < layout_.num_coded(); ++k) {
    const Eigen::VectorXf code = lobes.code(k).cast<float>();
    flow_.LogDensityOnColumns(
        table_.points, code.data(), num_threads_, log_q.data() + k * n,
        derivatives ? dcode.data() + k * n * code_size : nullptr);
  }
  std::vector<double> log_lobe(num_lobes);
  for (int c = 0; c < 3; ++c) {
    for (size_t i = 0; i < n; ++i) {
      // log(sum exp + floor), by its largest term.
      double top = std::log(floor_);
      const double log_floor = top;
      for (int k = 0; k < num_lobes; ++k) {
        log_lobe[k] = lobes.log_colour(k)[c] + exponent_ * log_q[k * n + i];
        top = std::max(top, log_lobe[k]);
      }
      double sum = std::exp(log_floor - top);
      for (int k = 0; k < num_lobes; ++k) sum += std::exp(log_lobe[k] - top);
      const double log_f = std::log(sum) + top;
      if (!std::isfinite(log_f)) return false;
      const size_t row = c * n + i;
      if (std::isinf(table_.log_raw[row])) {
        residuals[row] = 0.0;
        if (derivatives) {
          std::fill_n(jacobians[0] + row * layout_.num_parameters(),
                      layout_.num_parameters(), 0.0);
        }
        continue;
      }
      residuals[row] = scale_ * (log_f - table_.log_raw[row]);
      if (!derivatives) continue;
      const MutableLobeMixture j(layout_,
                                 jacobians[0] + row * layout_.num_parameters());
      for (int k = 0; k < num_lobes; ++k) {
        const double share = scale_ * std::exp(log_lobe[k] - log_f);
        for (int d = 0; d < j.code(k).size(); ++d) {
          const float dz = dcode[(k * code_size + d) * n + i];
          j.code(k)[d] = share * exponent_ * dz;
        }
        j.log_colour(k).setZero();
        j.log_colour(k)[c] = share;
      }
    }
  }
  return true;
}

}  // namespace ibrdf
