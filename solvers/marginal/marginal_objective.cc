#include "solvers/marginal/marginal_objective.h"

#include <glog/logging.h>

#include <algorithm>
#include <utility>

namespace ibrdf {

MarginalObjective::MarginalObjective(const MarginalReflectance* reflectance,
                                     const MaterialPrior* prior,
                                     double log_amplitude_std,
                                     Eigen::VectorXd noise, LightMode* mode,
                                     double mode_tolerance)
    : reflectance_(reflectance),
      prior_(prior),
      log_amplitude_std_(log_amplitude_std),
      noise_(std::move(noise)),
      mode_(mode),
      mode_tolerance_(mode_tolerance) {
  CHECK_EQ(reflectance->lobes().num_parameters(), prior->num_parameters());
}

int MarginalObjective::NumParameters() const {
  return prior_->num_parameters() + 1;
}

Eigen::VectorXd MarginalObjective::LobesOf(const double* y) const {
  return prior_->mean +
         prior_->factor.triangularView<Eigen::Lower>() *
             Eigen::Map<const Eigen::VectorXd>(y, prior_->num_parameters());
}

double MarginalObjective::LogAmplitudeOf(const double* y) const {
  return log_amplitude_std_ * y[prior_->num_parameters()];
}

std::vector<double> MarginalObjective::Whitened(const Eigen::VectorXd& lobes,
                                                double log_amplitude) const {
  const Eigen::VectorXd y =
      prior_->factor.triangularView<Eigen::Lower>().solve(lobes - prior_->mean);
  std::vector<double> out(y.data(), y.data() + y.size());
  out.push_back(log_amplitude / log_amplitude_std_);
  return out;
}

bool MarginalObjective::Evaluate(const double* y, double* cost,
                                 double* gradient) const {
  const Eigen::Index n = prior_->num_parameters();
  const Eigen::VectorXd lobes = LobesOf(y);
  std::vector<double> by_lobes;
  // A trial that a line search turns down must not move the mode's start.
  const bool tried =
      !trial_.empty() && std::equal(trial_.begin(), trial_.end(), y);
  LightMode mode = tried ? trial_mode_ : *mode_;
  const MarginalValue value = reflectance_->Evaluate(
      lobes.data(), noise_, LogAmplitudeOf(y), mode_tolerance_, &mode,
      gradient != nullptr ? &by_lobes : nullptr);
  if (!value.ok) return false;
  last_value_ = value;
  const Eigen::Map<const Eigen::VectorXd> whitened(y, n + 1);
  Eigen::VectorXd wall = Eigen::VectorXd::Zero(n);
  *cost = value.cost + 0.5 * whitened.squaredNorm() +
          prior_->WallCost(lobes, &wall);
  if (gradient == nullptr) {
    trial_.assign(y, y + n + 1);
    trial_mode_ = std::move(mode);
  } else {
    *mode_ = std::move(mode);
    wall += Eigen::Map<const Eigen::VectorXd>(by_lobes.data(), n);
    Eigen::Map<Eigen::VectorXd> out(gradient, n + 1);
    out = whitened;
    out.head(n) +=
        prior_->factor.triangularView<Eigen::Lower>().transpose() * wall;
    out[n] += log_amplitude_std_ * by_lobes[n];
  }
  return true;
}

Eigen::MatrixXd MarginalObjective::Information(const double* y) const {
  const Eigen::Index n = prior_->num_parameters();
  const Eigen::VectorXd lobes = LobesOf(y);
  Eigen::MatrixXd by_lobes = reflectance_->Information(
      lobes.data(), noise_, LogAmplitudeOf(y), *mode_);
  if (by_lobes.size() == 0 || !by_lobes.allFinite()) return {};
  prior_->AddWallInformation(lobes, &by_lobes);
  // Both sides by the whitening, whose last row is the amplitude's.
  Eigen::MatrixXd whitening = Eigen::MatrixXd::Zero(n + 1, n + 1);
  whitening.topLeftCorner(n, n) = prior_->factor.triangularView<Eigen::Lower>();
  whitening(n, n) = log_amplitude_std_;
  return Eigen::MatrixXd::Identity(n + 1, n + 1) +
         whitening.transpose() * by_lobes * whitening;
}

}  // namespace ibrdf
