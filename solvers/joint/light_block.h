// The unknown illumination of the joint estimate: a map as a function of
// parameters, with its priors.
#pragma once
#include <vector>

#include "ibrdf/solvers/illumination/illumination_model.h"
#include "ibrdf/solvers/priors/light_prior.h"

namespace ibrdf {

// map [H, W, 3] = exp(model(parameters)); prior
//   1/2 sum ((p_i - mean_i) / (sigma std_i))^2 + sum of light priors(log map),
// std = model.PriorStd(). Keeps the point of its last Linearise.
class LightBlock {
 public:
  // `model` and `priors` must outlive *this.
  LightBlock(IlluminationModel* model, std::vector<float> mean, double sigma,
             std::vector<LightPrior*> priors);

  int num_parameters() const { return model_->num_parameters(); }
  const std::vector<double>& inverse_variance() const {
    return inverse_variance_;
  }
  void set_mean(std::vector<float> mean);

  // The map and the prior's cost.
  double Evaluate(const float* parameters, std::vector<float>* map);
  // And the point of what follows.
  double Linearise(const float* parameters, std::vector<float>* map);

  const IlluminationModel& model() const { return *model_; }
  // Of the last Linearise: the map's derivatives by its logarithm [H, W, 3].
  const std::vector<float>& map_slopes() const { return map_slopes_; }

  // d log map and d map [H, W, 3] along v [parameters].
  void Jvp(const double* v, LogMap* d_log, std::vector<float>* d_map);
  // gradient [parameters] of sum by_map . map.
  void Vjp(const std::vector<float>& by_map, double* gradient);
  // The same plus the prior's gradient.
  void Gradient(const std::vector<float>& by_map, double* gradient);
  // Vjp(by_map) plus the prior's Gauss-Newton product with the v of d_log.
  void Product(const double* v, const LogMap& d_log,
               const std::vector<float>& by_map, double* product);

 private:
  double PriorCost(const float* parameters, LogMap* by_log);
  // out = J^T (by_log + slopes of the map * by_map)
  void Vjp(const std::vector<float>& by_map, LogMap by_log, double* out);

  IlluminationModel* model_;
  std::vector<float> mean_;
  const std::vector<LightPrior*> priors_;
  std::vector<double> inverse_variance_;
  LogMap log_map_;
  // The point of the last Linearise.
  std::vector<float> parameters_;
  LogMap prior_by_log_;
  std::vector<float> map_slopes_;  // of LogMap::Exp
  std::vector<float> tangent_, by_parameter_;
};

}  // namespace ibrdf
