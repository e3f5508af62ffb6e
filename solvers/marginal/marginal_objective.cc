#include "solvers/marginal/marginal_objective.h"

#include <glog/logging.h>

namespace ibrdf {
namespace {

// The mode is taken as found where a step gains less, nats: derivatives are
// then good to its root.
constexpr double kModeTolerance = 1e-3;

}  // namespace

MarginalObjective::MarginalObjective(const MarginalReflectance* reflectance,
                                     const MaterialPrior* prior,
                                     const HyperparameterPrior& hyper,
                                     LightMode* mode)
    : reflectance_(reflectance), prior_(prior), hyper_(hyper), mode_(mode) {
  CHECK_EQ(reflectance->lobes().num_parameters(), prior->num_parameters());
}

int MarginalObjective::NumParameters() const {
  return prior_->num_parameters() + 2;
}

Eigen::VectorXd MarginalObjective::LobesOf(const double* y) const {
  return prior_->mean +
         prior_->factor.triangularView<Eigen::Lower>() *
             Eigen::Map<const Eigen::VectorXd>(y, prior_->num_parameters());
}

MarginalHyperparameters MarginalObjective::HyperparametersOf(
    const double* y) const {
  const double* last = y + prior_->num_parameters();
  return {hyper_.mean.log_sigma + hyper_.log_sigma_std * last[0],
          hyper_.mean.log_amplitude + hyper_.log_amplitude_std * last[1]};
}

std::vector<double> MarginalObjective::Whitened(
    const Eigen::VectorXd& lobes, const MarginalHyperparameters& hyper) const {
  const Eigen::VectorXd y =
      prior_->factor.triangularView<Eigen::Lower>().solve(lobes - prior_->mean);
  std::vector<double> out(y.data(), y.data() + y.size());
  out.push_back((hyper.log_sigma - hyper_.mean.log_sigma) /
                hyper_.log_sigma_std);
  out.push_back((hyper.log_amplitude - hyper_.mean.log_amplitude) /
                hyper_.log_amplitude_std);
  return out;
}

bool MarginalObjective::Evaluate(const double* y, double* cost,
                                 double* gradient) const {
  const Eigen::Index n = prior_->num_parameters();
  const Eigen::VectorXd lobes = LobesOf(y);
  std::vector<double> by_lobes;
  // A trial that a line search turns down must not move the mode's start.
  LightMode mode = *mode_;
  const MarginalValue value =
      reflectance_->Evaluate(lobes.data(), HyperparametersOf(y), kModeTolerance,
                             &mode, gradient != nullptr ? &by_lobes : nullptr);
  if (!value.ok) return false;
  last_value_ = value;
  const Eigen::Map<const Eigen::VectorXd> whitened(y, n + 2);
  Eigen::VectorXd wall = Eigen::VectorXd::Zero(n);
  *cost = value.cost + 0.5 * whitened.squaredNorm() +
          prior_->WallCost(lobes, &wall);
  if (gradient != nullptr) {
    *mode_ = std::move(mode);
    wall += Eigen::Map<const Eigen::VectorXd>(by_lobes.data(), n);
    Eigen::Map<Eigen::VectorXd> out(gradient, n + 2);
    out = whitened;
    out.head(n) +=
        prior_->factor.triangularView<Eigen::Lower>().transpose() * wall;
    out[n] += hyper_.log_sigma_std * by_lobes[n];
    out[n + 1] += hyper_.log_amplitude_std * by_lobes[n + 1];
  }
  return true;
}

}  // namespace ibrdf
