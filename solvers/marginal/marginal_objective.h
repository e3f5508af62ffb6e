// The marginal posterior as a Ceres problem.
#pragma once
#include <ceres/first_order_function.h>

#include <Eigen/Core>
#include <vector>

#include "solvers/marginal/marginal_reflectance.h"
#include "solvers/material_prior.h"

namespace ibrdf {

// Log-normal priors of the hyperparameters, about `mean`.
struct HyperparameterPrior {
  MarginalHyperparameters mean;
  double log_sigma_std = 0.1;
  double log_amplitude_std = 0.7;
};

// -log posterior of a reflectance, in coordinates in which the prior is
// N(0, I): y [num_parameters + 2], lobes = mean + factor y, then the logs of
// sigma and amplitude. The light's mode of the last point with a gradient is
// kept as the next one's start.
class MarginalObjective final : public ceres::FirstOrderFunction {
 public:
  // All must outlive *this.
  MarginalObjective(const MarginalReflectance* reflectance,
                    const MaterialPrior* prior,
                    const HyperparameterPrior& hyper, LightMode* mode);

  int NumParameters() const override;
  bool Evaluate(const double* y, double* cost, double* gradient) const override;

  Eigen::VectorXd LobesOf(const double* y) const;
  MarginalHyperparameters HyperparametersOf(const double* y) const;
  // y of lobes and hyperparameters.
  std::vector<double> Whitened(const Eigen::VectorXd& lobes,
                               const MarginalHyperparameters& hyper) const;
  // Of the last evaluation that succeeded.
  const MarginalValue& last_value() const { return last_value_; }

 private:
  const MarginalReflectance* reflectance_;
  const MaterialPrior* prior_;
  const HyperparameterPrior hyper_;
  LightMode* mode_;
  mutable MarginalValue last_value_;
};

}  // namespace ibrdf
