#include "ibrdf/solvers/marginal/marginal_objective.h"

#include <glog/logging.h>

#include <algorithm>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"

namespace ibrdf {

MarginalObjective::MarginalObjective(const MarginalReflectance* reflectance,
                                     const MaterialPrior* prior,
                                     DataErrors errors, LightMode* mode,
                                     double mode_tolerance)
    : reflectance_(reflectance),
      prior_(prior),
      errors_(std::move(errors)),
      mode_(mode),
      mode_tolerance_(mode_tolerance) {
  CHECK_EQ(reflectance->num_lobe_parameters(), prior->num_parameters());
}

int MarginalObjective::NumParameters() const {
  return reflectance_->num_parameters() + LightHyperparameters::kCount;
}

Eigen::VectorXd MarginalObjective::LobesOf(const double* y) const {
  return prior_->mean +
         prior_->factor.triangularView<Eigen::Lower>() *
             Eigen::Map<const Eigen::VectorXd>(y, prior_->num_parameters());
}

Eigen::VectorXd MarginalObjective::ParametersOf(const double* y) const {
  const Eigen::Index all = reflectance_->num_parameters();
  Eigen::VectorXd out =
      kDirectionalLightOffsetStd * Eigen::Map<const Eigen::VectorXd>(y, all);
  out.head(prior_->num_parameters()) = LobesOf(y);
  return out;
}

LightHyperparameters MarginalObjective::HyperparametersOf(
    const double* y) const {
  return LightHyperparameters::FromWhitened(y + reflectance_->num_parameters());
}

std::vector<double> MarginalObjective::Whitened(
    const Eigen::VectorXd& parameters,
    const LightHyperparameters& hyperparameters) const {
  CHECK_EQ(parameters.size(), reflectance_->num_parameters());
  const Eigen::Index n = prior_->num_parameters();
  Eigen::VectorXd y = parameters / kDirectionalLightOffsetStd;
  y.head(n) = prior_->factor.triangularView<Eigen::Lower>().solve(
      parameters.head(n) - prior_->mean);
  std::vector<double> out = ToVector(y);
  const auto whitened = hyperparameters.Whitened();
  out.insert(out.end(), whitened.begin(), whitened.end());
  return out;
}

bool MarginalObjective::IsAt(const double* y) const {
  return !y_.empty() && std::equal(y_.begin(), y_.end(), y);
}

void MarginalObjective::Expand(const double* y) const {
  y_.assign(y, y + NumParameters());
  if (at_mode_) near_ = std::move(at_);
  at_mode_ = false;
  // A trial that a line search turns down must not move the mode's start.
  LightMode mode = *mode_;
  value_ = reflectance_->Expand(ParametersOf(y).data(), errors_,
                                HyperparametersOf(y), mode_tolerance_, &near_,
                                &mode, &at_);
}

bool MarginalObjective::Evaluate(const double* y, double* cost,
                                 double* gradient) const {
  const Eigen::Index n = prior_->num_parameters(), all = NumParameters();
  const Eigen::Index first_scale = reflectance_->num_parameters();
  if (!IsAt(y)) Expand(y);
  if (!value_.ok) return false;
  const Eigen::Map<const Eigen::VectorXd> whitened(y, all);
  Eigen::VectorXd wall = Eigen::VectorXd::Zero(n);
  *cost = value_.cost + 0.5 * whitened.squaredNorm() +
          prior_->WallCost(LobesOf(y), &wall);
  if (gradient != nullptr) {
    *mode_ = at_.likelihood->mode;
    at_mode_ = true;
    last_value_ = value_;
    const std::vector<double> by_parameter = reflectance_->Gradient(&at_);
    wall += Eigen::Map<const Eigen::VectorXd>(by_parameter.data(), n);
    Eigen::Map<Eigen::VectorXd> out(gradient, all);
    out = whitened;
    out.head(n) +=
        prior_->factor.triangularView<Eigen::Lower>().transpose() * wall;
    const auto stds = LightHyperparameters::Stds();
    for (Eigen::Index i = n; i < first_scale; ++i) {
      out[i] += kDirectionalLightOffsetStd * by_parameter[i];
    }
    for (int k = 0; k < LightHyperparameters::kCount; ++k) {
      out[first_scale + k] += stds[k] * by_parameter[first_scale + k];
    }
  }
  return true;
}

Eigen::MatrixXd MarginalObjective::Information(const double* y) const {
  const Eigen::Index n = prior_->num_parameters(), all = NumParameters();
  const Eigen::Index first_scale = reflectance_->num_parameters();
  const Eigen::VectorXd parameters = ParametersOf(y);
  const int steps = prior_->materials.size() > 1 ? kHyperparameterSteps : 1;
  if (information_calls_++ % steps == 0) {
    of_hyperparameters_.resize(0, 0);
  }
  Eigen::MatrixXd information =
      IsAt(y) && value_.ok
          ? reflectance_->Information(&at_, &of_hyperparameters_)
          : reflectance_->Information(parameters.data(), errors_,
                                      HyperparametersOf(y), *mode_,
                                      &of_hyperparameters_);
  if (information.size() == 0 || !information.allFinite()) return {};
  prior_->AddWallInformation(parameters.head(n), &information);
  // Both sides by the whitening.
  Eigen::MatrixXd whitening = Eigen::MatrixXd::Zero(all, all);
  whitening.topLeftCorner(n, n) = prior_->factor.triangularView<Eigen::Lower>();
  const auto stds = LightHyperparameters::Stds();
  for (Eigen::Index i = n; i < first_scale; ++i) {
    whitening(i, i) = kDirectionalLightOffsetStd;
  }
  for (int k = 0; k < LightHyperparameters::kCount; ++k) {
    whitening(first_scale + k, first_scale + k) = stds[k];
  }
  return Eigen::MatrixXd::Identity(all, all) +
         whitening.transpose() * information * whitening;
}

}  // namespace ibrdf
