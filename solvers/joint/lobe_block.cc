#include "ibrdf/solvers/joint/lobe_block.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/solvers/costs/log_radiance_cost.h"

namespace ibrdf {

LobeBlock::LobeBlock(const Transport* transport, const LobeModel* lobes,
                     const LobePrior& prior)
    : transport_(transport), lobes_(lobes), prior_(prior) {
  for (int i = 0; i < lobes->num_parameters(); ++i) {
    const bool code = i % lobes->lobe_size() < lobes->code_size();
    const double sigma = code ? prior.sigma : prior.colour_sigma;
    inverse_variance_.push_back(1.0 / (sigma * sigma));
  }
}

BrdfGrid LobeBlock::Grid(const double* parameters) const {
  return lobes_->Grid(parameters);
}

RowMajorMatrix LobeBlock::RadianceJacobian(const double* parameters,
                                           const float* map) const {
  std::vector<double> L_o, dL_o;
  RenderLobeModel(*transport_, *lobes_, parameters, map, &L_o, &dL_o);
  return Eigen::Map<const RowMajorMatrix>(
      dL_o.data(), static_cast<Eigen::Index>(L_o.size()), num_parameters());
}

void LobeBlock::ReverseGradient(const double* parameters, const float* map,
                                const std::vector<double>& adjoint,
                                double* gradient) const {
  const size_t nodes = lobes_->grid_shape().num_nodes();
  const int codes = lobes_->code_size(), stride = 1 + codes;
  std::vector<float> by_grid(3 * nodes), fields;
  lobes_->Tabulate(parameters, true, &fields);
  const BrdfGrid grid = lobes_->Combine(parameters, fields, stride);
  transport_->GridGradient(grid, map, adjoint.data(), by_grid.data());
  for (int k = 0; k < lobes_->num_lobes(); ++k) {
    const size_t first = static_cast<size_t>(k) * lobes_->lobe_size();
    const double* lobe = parameters + first;
    double colour[3];
    for (int c = 0; c < 3; ++c) {
      colour[c] =
          std::exp(std::min(lobe[codes + c], LobeModel::kMaxLogColour)) *
          kMerlScale[c];
    }
    // by_shape: the gradient in the lobe's shape s_k, which all channels share.
    std::vector<double> by_shape(nodes);
    const float* shape = fields.data() + nodes * stride * k;
    double* g = gradient + first;
    for (int c = 0; c < 3; ++c) {
      const float* by_channel = by_grid.data() + c * nodes;
      double sum = 0.0;
      for (size_t i = 0; i < nodes; ++i) {
        sum += static_cast<double>(by_channel[i]) * shape[i];
        by_shape[i] += colour[c] * by_channel[i];
      }
      g[codes + c] =
          lobe[codes + c] < LobeModel::kMaxLogColour ? colour[c] * sum : 0.0;
    }
    for (int d = 0; d < codes; ++d) {
      const float* derivative = shape + (1 + d) * nodes;
      double sum = 0.0;
      for (size_t i = 0; i < nodes; ++i) sum += by_shape[i] * derivative[i];
      g[d] = sum;
    }
  }
}

double LobeBlock::Prior(const double* parameters, double* gradient,
                        Eigen::MatrixXd* hessian) const {
  const LobePriorCost cost(lobes_->num_lobes(), lobes_->code_size(), prior_);
  Eigen::VectorXd residuals(cost.num_residuals());
  if (gradient == nullptr && hessian == nullptr) {
    cost.Evaluate(&parameters, residuals.data(), nullptr);
    return residuals.squaredNorm() / 2;
  }
  RowMajorMatrix jacobian(cost.num_residuals(), num_parameters());
  double* jacobians[] = {jacobian.data()};
  cost.Evaluate(&parameters, residuals.data(), jacobians);
  if (gradient != nullptr) {
    Eigen::Map<Eigen::VectorXd>(gradient, num_parameters()) +=
        jacobian.transpose() * residuals;
  }
  if (hessian != nullptr) *hessian += jacobian.transpose() * jacobian;
  return residuals.squaredNorm() / 2;
}

}  // namespace ibrdf
