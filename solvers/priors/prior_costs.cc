#include "ibrdf/solvers/priors/prior_costs.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {

LobePriorCost::LobePriorCost(int num_lobes, int code_size,
                             const LobePrior& prior)
    : num_lobes_(num_lobes), code_size_(code_size), prior_(prior) {
  mutable_parameter_block_sizes()->push_back(num_lobes * (code_size + 3));
  set_num_residuals(num_lobes * (code_size + 4));
}

bool LobePriorCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  const int columns = num_lobes_ * (code_size_ + 3);
  double* J = jacobians != nullptr ? jacobians[0] : nullptr;
  if (J != nullptr) std::fill(J, J + num_residuals() * columns, 0.0);
  for (int k = 0; k < num_lobes_; ++k) {
    const int first = k * (code_size_ + 3), row = k * (code_size_ + 4);
    const double* z = parameters[0] + first;
    double square = 0.0;
    for (int d = 0; d < code_size_; ++d) {
      residuals[row + d] = z[d] / prior_.sigma;
      square += z[d] * z[d];
      if (J != nullptr) J[(row + d) * columns + first + d] = 1 / prior_.sigma;
    }
    const double norm = std::sqrt(square);
    const int wall = row + code_size_;
    residuals[wall] = prior_.wall * std::max(0.0, norm - 1.0);
    if (J != nullptr && norm > 1.0) {
      for (int d = 0; d < code_size_; ++d) {
        J[wall * columns + first + d] = prior_.wall * z[d] / norm;
      }
    }
    for (int c = 0; c < 3; ++c) {
      residuals[wall + 1 + c] =
          (z[code_size_ + c] - prior_.colour_mean[c]) / prior_.colour_sigma;
      if (J != nullptr) {
        J[(wall + 1 + c) * columns + first + code_size_ + c] =
            1 / prior_.colour_sigma;
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
