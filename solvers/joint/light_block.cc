#include "ibrdf/solvers/joint/light_block.h"

#include <glog/logging.h>

namespace ibrdf {

LightBlock::LightBlock(IlluminationModel* model, std::vector<float> mean,
                       double sigma, std::vector<LightPrior*> priors)
    : model_(model),
      priors_(std::move(priors)),
      tangent_(model->num_parameters()),
      by_parameter_(model->num_parameters()) {
  set_mean(std::move(mean));
  for (const float s : model->PriorStd()) {
    inverse_variance_.push_back(1.0 / (sigma * sigma * s * s));
  }
}

void LightBlock::set_mean(std::vector<float> mean) {
  CHECK_EQ(static_cast<int>(mean.size()), num_parameters());
  mean_ = std::move(mean);
}

double LightBlock::PriorCost(const float* parameters, LogMap* by_log) {
  double cost = 0.0;
  for (LightPrior* prior : priors_) {
    cost += prior->Evaluate(log_map_, by_log);
  }
  for (size_t i = 0; i < mean_.size(); ++i) {
    const double d = static_cast<double>(parameters[i]) - mean_[i];
    cost += 0.5 * inverse_variance_[i] * d * d;
  }
  return cost;
}

double LightBlock::Evaluate(const float* parameters, std::vector<float>* map) {
  model_->Forward(parameters, &log_map_);
  log_map_.Exp(map);
  return PriorCost(parameters, nullptr);
}

double LightBlock::Linearise(const float* parameters, std::vector<float>* map) {
  parameters_.assign(parameters, parameters + num_parameters());
  model_->Linearise(parameters, &log_map_);
  log_map_.Exp(map, &map_slopes_);
  prior_by_log_ = LogMap(log_map_.size());
  return PriorCost(parameters, &prior_by_log_);
}

void LightBlock::Jvp(const double* v, LogMap* d_log,
                     std::vector<float>* d_map) {
  for (size_t i = 0; i < tangent_.size(); ++i) {
    tangent_[i] = static_cast<float>(v[i]);
  }
  model_->Jvp(tangent_.data(), d_log);
  ExpJvp(map_slopes_, *d_log, d_map);
}

void LightBlock::Vjp(const std::vector<float>& by_map, LogMap by_log,
                     double* out) {
  AddExpVjp(map_slopes_, by_map, &by_log);
  model_->Vjp(by_log, by_parameter_.data());
  for (size_t i = 0; i < by_parameter_.size(); ++i) out[i] = by_parameter_[i];
}

void LightBlock::Vjp(const std::vector<float>& by_map, double* gradient) {
  Vjp(by_map, LogMap(model_->size()), gradient);
}

void LightBlock::Gradient(const std::vector<float>& by_map, double* gradient) {
  Vjp(by_map, prior_by_log_, gradient);
  for (size_t i = 0; i < mean_.size(); ++i) {
    gradient[i] +=
        inverse_variance_[i] * (static_cast<double>(parameters_[i]) - mean_[i]);
  }
}

void LightBlock::Product(const double* v, const LogMap& d_log,
                         const std::vector<float>& by_map, double* product) {
  LogMap by_log(model_->size());
  for (const LightPrior* prior : priors_) prior->AddProduct(d_log, &by_log);
  Vjp(by_map, std::move(by_log), product);
  for (size_t i = 0; i < mean_.size(); ++i) {
    product[i] += inverse_variance_[i] * v[i];
  }
}

}  // namespace ibrdf
