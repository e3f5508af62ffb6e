// The marginal posterior as a Ceres problem.
#pragma once
#include <ceres/first_order_function.h>

#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/marginal/marginal_reflectance.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// -log posterior of a reflectance, in coordinates in which the prior is
// N(0, I): y [num_parameters + hyperparameters], lobes = mean + factor y, then
// the directional lights' offsets, then LightHyperparameters::Whitened. The
// light's mode of the last point with a gradient is the next one's start. What
// was found at the last point is kept: its derivatives need no other search.
class MarginalObjective final : public ceres::FirstOrderFunction {
 public:
  // The light's mode is taken as found where a step gains less, nats:
  // derivatives are then good to its root.
  static constexpr double kModeTolerance = 1e-6;
  // Deviation of a directional light's offset, radians.
  static constexpr double kDirectionalLightOffsetStd = 0.05;

  // All must outlive *this.
  MarginalObjective(const MarginalReflectance* reflectance,
                    const MaterialPrior* prior, DataErrors errors,
                    LightMode* mode, double mode_tolerance = kModeTolerance);

  int NumParameters() const override;
  bool Evaluate(const double* y, double* cost, double* gradient) const override;

  // Gauss-Newton Hessian [NumParameters()]^2 at y, where Evaluate with a
  // gradient was called last: prior, wall and MarginalReflectance::Information.
  // Positive definite; empty where there is none. The block of the
  // hyperparameters hardly changes from step to step: it is made anew at every
  // kHyperparameterSteps-th call, the first among them. Under a known
  // reflectance, one material, there is little else to find: at every call.
  static constexpr int kHyperparameterSteps = 4;
  Eigen::MatrixXd Information(const double* y) const;

  // MarginalReflectance's, and the lobes' among them.
  Eigen::VectorXd ParametersOf(const double* y) const;
  Eigen::VectorXd LobesOf(const double* y) const;
  LightHyperparameters HyperparametersOf(const double* y) const;
  std::vector<double> Whitened(
      const Eigen::VectorXd& parameters,
      const LightHyperparameters& hyperparameters) const;
  // The value of the last evaluation with a gradient that succeeded: not of a
  // trial that a line search turned down.
  const MarginalValue& last_value() const { return last_value_; }

 private:
  bool IsAt(const double* y) const;
  void Expand(const double* y) const;

  const MarginalReflectance* reflectance_;
  const MaterialPrior* prior_;
  const DataErrors errors_;
  LightMode* mode_;
  const double mode_tolerance_;
  // The last point, what was found there, and that of the last one with a
  // gradient before it, of which *mode_ is.
  mutable std::vector<double> y_;
  mutable MarginalValue value_;
  mutable MarginalReflectance::Expansion at_, near_;
  mutable bool at_mode_ = false;  // *mode_ is of at_
  mutable MarginalValue last_value_;
  mutable Eigen::MatrixXd of_hyperparameters_;  // of Information
  mutable int information_calls_ = 0;
};

}  // namespace ibrdf
