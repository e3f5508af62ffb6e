#include "ibrdf/solvers/illumination/log_map_fit.h"

#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/optim/conjugate_gradients.h"

namespace ibrdf {
namespace {

// What is left of the squared residual of a step's equations, in the prior's
// metric.
constexpr double kForcing = 1e-3;
// So many steps in a row without a gain are the end: far from its fit a network
// may have one that gains nothing and then halve the cost with the next.
constexpr int kIdleSteps = 2;

class LogMapFit {
 public:
  LogMapFit(const LogMap& target, double sigma, IlluminationModel* model,
            const std::vector<float>& mean)
      : model_(model),
        target_(target),
        mean_(mean),
        log_map_(target.size()),
        by_map_(target.size()),
        by_parameter_(mean.size()),
        tangent_(mean.size()) {
    CHECK(target.size() == model->size());
    CHECK_EQ(static_cast<int>(mean.size()), model->num_parameters());
    const int H = model->height(), W = model->width();
    const double equator = TexelSolidAngle(H / 2, H, W);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < H; ++r) {
        weight_.insert(weight_.end(), W,
                       TexelSolidAngle(r, H, W) / equator / (sigma * sigma));
      }
    }
    const std::vector<float> std = model->PriorStd();
    precision_.resize(static_cast<Eigen::Index>(std.size()));
    for (Eigen::Index i = 0; i < precision_.size(); ++i) {
      precision_[i] = 1.0 / (static_cast<double>(std[i]) * std[i]);
    }
  }

  double Cost(const std::vector<float>& parameters) {
    model_->Forward(parameters.data(), &log_map_);
    return CostAtMap(parameters);
  }

  // -step . gradient > 0; damping: of the prior's precision.
  Eigen::VectorXd Step(const std::vector<float>& parameters, double damping,
                       int max_iterations) {
    model_->Linearise(parameters.data(), &log_map_);
    for (size_t i = 0; i < weight_.size(); ++i) {
      by_map_.data()[i] = static_cast<float>(
          weight_[i] * (log_map_.data()[i] - target_.data()[i]));
    }
    Eigen::VectorXd residual = -Vjp();
    for (Eigen::Index i = 0; i < residual.size(); ++i) {
      residual[i] -= precision_[i] * (parameters[i] - mean_[i]);
    }
    const Eigen::VectorXd diagonal = (1.0 + damping) * precision_;
    const auto product = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
      for (size_t i = 0; i < tangent_.size(); ++i) {
        tangent_[i] = static_cast<float>(v[static_cast<Eigen::Index>(i)]);
      }
      model_->Jvp(tangent_.data(), &by_map_);
      for (size_t i = 0; i < weight_.size(); ++i) {
        float& value = by_map_.data()[i];
        value = static_cast<float>(weight_[i] * value);
      }
      return Vjp() + diagonal.cwiseProduct(v);
    };
    const auto precondition = [&](const Eigen::VectorXd& r) -> Eigen::VectorXd {
      return r.cwiseQuotient(diagonal);
    };
    return ConjugateGradients(product, precondition, residual, max_iterations,
                              kForcing);
  }

 private:
  double CostAtMap(const std::vector<float>& parameters) const {
    double cost = 0.0;
    for (size_t i = 0; i < weight_.size(); ++i) {
      const double d =
          static_cast<double>(log_map_.data()[i]) - target_.data()[i];
      cost += 0.5 * weight_[i] * d * d;
    }
    for (size_t i = 0; i < mean_.size(); ++i) {
      const double d = static_cast<double>(parameters[i]) - mean_[i];
      cost += 0.5 * precision_[static_cast<Eigen::Index>(i)] * d * d;
    }
    return cost;
  }
  // The gradient by the parameters, from by_map_.
  Eigen::VectorXd Vjp() {
    model_->Vjp(by_map_, by_parameter_.data());
    return Eigen::Map<const Eigen::VectorXf>(
               by_parameter_.data(),
               static_cast<Eigen::Index>(by_parameter_.size()))
        .cast<double>();
  }

  IlluminationModel* model_;
  const LogMap& target_;
  const std::vector<float> mean_;
  LogMap log_map_, by_map_;
  std::vector<float> by_parameter_, tangent_;
  std::vector<double> weight_;
  Eigen::VectorXd precision_;
};

}  // namespace

double FitLogMap(const LogMap& target, const LogMapFitOptions& options,
                 IlluminationModel* model, std::vector<float>* parameters) {
  LogMapFit fit(target, options.sigma, model, *parameters);
  double cost = fit.Cost(*parameters), damping = 1.0;
  int idle = 0;
  for (int k = 0; k < options.max_iterations; ++k) {
    if (options.should_stop && options.should_stop()) break;
    const Eigen::VectorXd step =
        fit.Step(*parameters, damping, options.max_cg_iterations);
    const double before = cost;
    double length = 1.0;
    for (; length > 0.02; length *= 0.4) {
      std::vector<float> candidate = *parameters;
      for (size_t i = 0; i < candidate.size(); ++i) {
        candidate[i] +=
            static_cast<float>(length * step[static_cast<Eigen::Index>(i)]);
      }
      const double trial = fit.Cost(candidate);
      if (!(trial < cost)) continue;
      cost = trial;
      *parameters = std::move(candidate);
      break;
    }
    if (length == 1.0) {
      damping = std::max(damping / 4, 1e-4);
    } else {
      damping *= length > 0.02 ? 2 : 16;
    }
    if (cost < before) {
      idle = before - cost < options.tolerance * before ? idle + 1 : 0;
      if (idle == kIdleSteps) break;
    }
    if (damping > 1e6) break;
  }
  return cost;
}

}  // namespace ibrdf
