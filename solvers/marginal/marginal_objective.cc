#include "solvers/marginal/marginal_objective.h"

#include <glog/logging.h>

#include <algorithm>
#include <utility>

#include "solvers/eigen_vectors.h"

namespace ibrdf {

MarginalObjective::MarginalObjective(const MarginalReflectance* reflectance,
                                     const MaterialPrior* prior,
                                     Eigen::VectorXd noise, LightMode* mode,
                                     double mode_tolerance)
    : reflectance_(reflectance),
      prior_(prior),
      noise_(std::move(noise)),
      mode_(mode),
      mode_tolerance_(mode_tolerance) {
  CHECK_EQ(reflectance->lobes().num_parameters(), prior->num_parameters());
}

int MarginalObjective::NumParameters() const {
  return prior_->num_parameters() + LightScales::kCount;
}

Eigen::VectorXd MarginalObjective::LobesOf(const double* y) const {
  return prior_->mean +
         prior_->factor.triangularView<Eigen::Lower>() *
             Eigen::Map<const Eigen::VectorXd>(y, prior_->num_parameters());
}

LightScales MarginalObjective::ScalesOf(const double* y) const {
  return LightScales::FromWhitened(y + prior_->num_parameters());
}

std::vector<double> MarginalObjective::Whitened(
    const Eigen::VectorXd& lobes, const LightScales& scales) const {
  const Eigen::VectorXd y =
      prior_->factor.triangularView<Eigen::Lower>().solve(lobes - prior_->mean);
  std::vector<double> out = ToVector(y);
  const auto whitened = scales.Whitened();
  out.insert(out.end(), whitened.begin(), whitened.end());
  return out;
}

bool MarginalObjective::Evaluate(const double* y, double* cost,
                                 double* gradient) const {
  const Eigen::Index n = prior_->num_parameters(), all = NumParameters();
  const Eigen::VectorXd lobes = LobesOf(y);
  std::vector<double> by_lobes;
  // A trial that a line search turns down must not move the mode's start.
  const bool tried =
      !trial_.empty() && std::equal(trial_.begin(), trial_.end(), y);
  LightMode mode = tried ? trial_mode_ : *mode_;
  const MarginalValue value =
      reflectance_->Evaluate(lobes.data(), noise_, ScalesOf(y), mode_tolerance_,
                             &mode, gradient != nullptr ? &by_lobes : nullptr);
  if (!value.ok) return false;
  last_value_ = value;
  const Eigen::Map<const Eigen::VectorXd> whitened(y, all);
  Eigen::VectorXd wall = Eigen::VectorXd::Zero(n);
  *cost = value.cost + 0.5 * whitened.squaredNorm() +
          prior_->WallCost(lobes, &wall);
  if (gradient == nullptr) {
    trial_.assign(y, y + all);
    trial_mode_ = std::move(mode);
  } else {
    *mode_ = std::move(mode);
    wall += Eigen::Map<const Eigen::VectorXd>(by_lobes.data(), n);
    Eigen::Map<Eigen::VectorXd> out(gradient, all);
    out = whitened;
    out.head(n) +=
        prior_->factor.triangularView<Eigen::Lower>().transpose() * wall;
    const auto stds = LightScales::Stds();
    for (int k = 0; k < LightScales::kCount; ++k) {
      out[n + k] += stds[k] * by_lobes[n + k];
    }
  }
  return true;
}

Eigen::MatrixXd MarginalObjective::Information(const double* y) const {
  const Eigen::Index n = prior_->num_parameters(), all = NumParameters();
  const Eigen::VectorXd lobes = LobesOf(y);
  Eigen::MatrixXd by_lobes =
      reflectance_->Information(lobes.data(), noise_, ScalesOf(y), *mode_);
  if (by_lobes.size() == 0 || !by_lobes.allFinite()) return {};
  prior_->AddWallInformation(lobes, &by_lobes);
  // Both sides by the whitening, whose last rows are the scales'.
  Eigen::MatrixXd whitening = Eigen::MatrixXd::Zero(all, all);
  whitening.topLeftCorner(n, n) = prior_->factor.triangularView<Eigen::Lower>();
  const auto stds = LightScales::Stds();
  for (int k = 0; k < LightScales::kCount; ++k) {
    whitening(n + k, n + k) = stds[k];
  }
  return Eigen::MatrixXd::Identity(all, all) +
         whitening.transpose() * by_lobes * whitening;
}

}  // namespace ibrdf
