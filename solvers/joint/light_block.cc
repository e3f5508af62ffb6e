#include "ibrdf/solvers/joint/light_block.h"

#include <glog/logging.h>

namespace ibrdf {

LightBlock::LightBlock(IlluminationModel* model, std::vector<float> mean,
                       double sigma, std::vector<LightPrior*> priors)
    : model_(model),
      priors_(std::move(priors)),
      log_map_(model->num_outputs()),
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

double LightBlock::PriorCost(const float* parameters, float* by_log) {
  double cost = 0.0;
  for (LightPrior* prior : priors_) {
    cost += prior->Evaluate(log_map_.data(), by_log);
  }
  for (size_t i = 0; i < mean_.size(); ++i) {
    const double d = static_cast<double>(parameters[i]) - mean_[i];
    cost += 0.5 * inverse_variance_[i] * d * d;
  }
  return cost;
}

double LightBlock::Evaluate(const float* parameters, std::vector<float>* map) {
  model_->Forward(parameters, log_map_.data());
  ToRadianceMap(log_map_, map);
  return PriorCost(parameters, nullptr);
}

double LightBlock::Linearise(const float* parameters, std::vector<float>* map) {
  parameters_.assign(parameters, parameters + num_parameters());
  model_->Linearise(parameters, log_map_.data());
  ToRadianceMap(log_map_, map, &map_slopes_);
  prior_by_log_.assign(log_map_.size(), 0.0f);
  return PriorCost(parameters, prior_by_log_.data());
}

void LightBlock::Jvp(const double* v, std::vector<float>* d_log,
                     std::vector<float>* d_map) {
  for (size_t i = 0; i < tangent_.size(); ++i) {
    tangent_[i] = static_cast<float>(v[i]);
  }
  d_log->resize(map_slopes_.size());
  d_map->resize(map_slopes_.size());
  model_->Jvp(tangent_.data(), d_log->data());
  const size_t texels = map_slopes_.size() / 3;
  for (size_t t = 0; t < texels; ++t) {
    for (size_t c = 0; c < 3; ++c) {
      (*d_map)[3 * t + c] = map_slopes_[3 * t + c] * (*d_log)[c * texels + t];
    }
  }
}

void LightBlock::Vjp(const std::vector<float>& by_map,
                     std::vector<float> by_log, double* out) {
  const size_t texels = map_slopes_.size() / 3;
  for (size_t t = 0; t < texels; ++t) {
    for (size_t c = 0; c < 3; ++c) {
      by_log[c * texels + t] += by_map[3 * t + c] * map_slopes_[3 * t + c];
    }
  }
  model_->Vjp(by_log.data(), by_parameter_.data());
  for (size_t i = 0; i < by_parameter_.size(); ++i) out[i] = by_parameter_[i];
}

void LightBlock::Vjp(const std::vector<float>& by_map, double* gradient) {
  Vjp(by_map, std::vector<float>(by_map.size(), 0.0f), gradient);
}

void LightBlock::Gradient(const std::vector<float>& by_map, double* gradient) {
  Vjp(by_map, prior_by_log_, gradient);
  for (size_t i = 0; i < mean_.size(); ++i) {
    gradient[i] +=
        inverse_variance_[i] * (static_cast<double>(parameters_[i]) - mean_[i]);
  }
}

void LightBlock::Product(const double* v, const std::vector<float>& d_log,
                         const std::vector<float>& by_map, double* product) {
  std::vector<float> by_log(by_map.size(), 0.0f);
  for (const LightPrior* prior : priors_) {
    prior->AddProduct(d_log.data(), by_log.data());
  }
  Vjp(by_map, std::move(by_log), product);
  for (size_t i = 0; i < mean_.size(); ++i) {
    product[i] += inverse_variance_[i] * v[i];
  }
}

}  // namespace ibrdf
