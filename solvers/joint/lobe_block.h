// The unknown reflectance of the joint estimate: lobes with their prior.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/solvers/optim/dense_algebra.h"
#include "ibrdf/solvers/priors/prior_costs.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// Parameters as LobeModel's. Immutable.
class LobeBlock {
 public:
  // `transport` and `lobes` must outlive *this.
  LobeBlock(const Transport* transport, const LobeModel* lobes,
            const LobePrior& prior);

  int num_parameters() const { return lobes_->num_parameters(); }
  // Those of the Gaussians of codes and colours.
  const std::vector<double>& inverse_variance() const {
    return inverse_variance_;
  }

  BrdfGrid Grid(const double* parameters) const;

  // dL_o [points * 3, parameters] under a map [H, W, 3]: one scalar field per
  // lobe and code entry, rendered together.
  RowMatrix RadianceJacobian(const double* parameters, const float* map) const;
  // Gradient [parameters] of sum adjoint . L_o in one reverse pass, which costs
  // two renders whatever the number of parameters.
  void ReverseGradient(const double* parameters, const float* map,
                       const std::vector<double>& adjoint,
                       double* gradient) const;

  // Cost of the prior; with `gradient` adds its gradient, with `hessian` its
  // Gauss-Newton matrix (either may be null).
  double Prior(const double* parameters, double* gradient,
               Eigen::MatrixXd* hessian) const;

 private:
  const Transport* transport_;
  const LobeModel* lobes_;
  const LobePrior prior_;
  std::vector<double> inverse_variance_;
};

}  // namespace ibrdf
