#include "ibrdf/solvers/joint/lobe_block.h"

#include "ibrdf/solvers/costs/log_radiance_cost.h"

namespace ibrdf {

LobeBlock::LobeBlock(const Transport* transport, const LobeModel* lobes,
                     const LobePrior& prior)
    : transport_(transport), lobes_(lobes), prior_(prior) {
  inverse_variance_.resize(lobes->num_parameters());
  const MutableLobeMixture of_lobes = lobes->Mixture(inverse_variance_.data());
  for (int k = 0; k < lobes->num_lobes(); ++k) {
    of_lobes.code(k).setConstant(1.0 / (prior.sigma * prior.sigma));
    of_lobes.log_colour(k).setConstant(
        1.0 / (prior.colour_sigma * prior.colour_sigma));
  }
}

BrdfGrid LobeBlock::Grid(const double* parameters) const {
  return lobes_->Grid(parameters);
}

RowMatrix LobeBlock::RadianceJacobian(const double* parameters,
                                      const float* map) const {
  std::vector<double> L_o, dL_o;
  RenderLobeModel(*transport_, *lobes_, parameters, map, &L_o, &dL_o);
  return Eigen::Map<const RowMatrix>(
      dL_o.data(), static_cast<Eigen::Index>(L_o.size()), num_parameters());
}

void LobeBlock::ReverseGradient(const double* parameters, const float* map,
                                const std::vector<double>& adjoint,
                                double* gradient) const {
  const size_t nodes = lobes_->grid_shape().num_nodes();
  const int stride = 1 + lobes_->code_size();
  std::vector<float> by_grid(3 * nodes), fields;
  lobes_->Tabulate(parameters, true, &fields);
  const BrdfGrid grid = lobes_->Combine(parameters, fields, stride);
  transport_->GridGradient(grid, map, adjoint.data(), by_grid.data());
  const LobeMixture mixture = lobes_->Mixture(parameters);
  const Eigen::Array3Xd colours = mixture.Colours();
  const Eigen::Array3Xd slopes = mixture.ColourSlopes();
  const MutableLobeMixture by_lobe = lobes_->Mixture(gradient);
  for (int k = 0; k < lobes_->num_lobes(); ++k) {
    // by_shape: the gradient in the lobe's shape s_k, which all channels share.
    std::vector<double> by_shape(nodes);
    const float* shape = fields.data() + nodes * stride * k;
    for (int c = 0; c < 3; ++c) {
      const float* by_channel = by_grid.data() + c * nodes;
      double sum = 0.0;
      for (size_t i = 0; i < nodes; ++i) {
        sum += static_cast<double>(by_channel[i]) * shape[i];
        by_shape[i] += colours(c, k) * by_channel[i];
      }
      by_lobe.log_colour(k)[c] = slopes(c, k) * sum;
    }
    for (int d = 0; d < mixture.code(k).size(); ++d) {
      const float* derivative = shape + (1 + d) * nodes;
      double sum = 0.0;
      for (size_t i = 0; i < nodes; ++i) sum += by_shape[i] * derivative[i];
      by_lobe.code(k)[d] = sum;
    }
  }
}

double LobeBlock::Prior(const double* parameters, double* gradient,
                        Eigen::MatrixXd* hessian) const {
  const LobePriorCost cost(lobes_->layout(), prior_);
  Eigen::VectorXd residuals(cost.num_residuals());
  if (gradient == nullptr && hessian == nullptr) {
    cost.Evaluate(&parameters, residuals.data(), nullptr);
    return residuals.squaredNorm() / 2;
  }
  RowMatrix jacobian(cost.num_residuals(), num_parameters());
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
