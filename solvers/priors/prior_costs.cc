#include "ibrdf/solvers/priors/prior_costs.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {

LobePriorCost::LobePriorCost(const LobeLayout& layout, const LobePrior& prior)
    : layout_(layout), prior_(prior) {
  mutable_parameter_block_sizes()->push_back(layout.num_parameters());
  set_num_residuals(layout.num_parameters() + layout.num_coded());
}

bool LobePriorCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  const int columns = layout_.num_parameters();
  const LobeMixture lobes(layout_, parameters[0]);
  double* J = jacobians != nullptr ? jacobians[0] : nullptr;
  if (J != nullptr) std::fill(J, J + num_residuals() * columns, 0.0);
  const auto jacobian_row = [&](int row) {
    return MutableLobeMixture(layout_, J + row * columns);
  };
  for (int k = 0; k < layout_.num_lobes; ++k) {
    const auto z = lobes.code(k);
    int row = k * (layout_.lobe_size() + 1);
    double square = 0.0;
    for (int d = 0; d < z.size(); ++d, ++row) {
      residuals[row] = z[d] / prior_.sigma;
      square += z[d] * z[d];
      if (J != nullptr) jacobian_row(row).code(k)[d] = 1 / prior_.sigma;
    }
    if (k < layout_.num_coded()) {
      const double norm = std::sqrt(square);
      residuals[row] = prior_.wall * std::max(0.0, norm - 1.0);
      if (J != nullptr && norm > 1.0) {
        jacobian_row(row).code(k) = prior_.wall * z / norm;
      }
      ++row;
    }
    for (int c = 0; c < 3; ++c, ++row) {
      residuals[row] = (lobes.log_colour(k)[c] - prior_.colour_mean[c]) /
                       prior_.colour_sigma;
      if (J != nullptr) {
        jacobian_row(row).log_colour(k)[c] = 1 / prior_.colour_sigma;
      }
    }
  }
  return true;
}

WeightPriorCost::WeightPriorCost(std::vector<float> mean,
                                 std::vector<float> std, double sigma)
    : mean_(std::move(mean)), std_(std::move(std)), sigma_(sigma) {
  CHECK_EQ(mean_.size(), std_.size());
  mutable_parameter_block_sizes()->push_back(static_cast<int>(mean_.size()));
  set_num_residuals(static_cast<int>(mean_.size()));
}

bool WeightPriorCost::Evaluate(double const* const* parameters,
                               double* residuals, double** jacobians) const {
  const size_t n = mean_.size();
  double* J = jacobians != nullptr ? jacobians[0] : nullptr;
  if (J != nullptr) std::fill(J, J + n * n, 0.0);
  for (size_t i = 0; i < n; ++i) {
    const double inverse = 1.0 / (sigma_ * static_cast<double>(std_[i]));
    residuals[i] = (parameters[0][i] - mean_[i]) * inverse;
    if (J != nullptr) J[i * n + i] = inverse;
  }
  return true;
}

}  // namespace ibrdf
