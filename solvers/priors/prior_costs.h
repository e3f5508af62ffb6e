// Priors as residuals.
#pragma once
#include <ceres/cost_function.h>

#include <vector>

#include "ibrdf/brdf/lobe_mixture.h"

namespace ibrdf {

// p(z) = N(0, sigma^2 I) for the code of every lobe (Chen et al. 2020,
// Sec. 4.3), with a wall where the unit ball ends, as no training code lies
// beyond; and a Gaussian on log colours, which fixes the scale between
// reflectance and light that the image leaves open.
//   z_kd / sigma;  wall * max(0, |z_k| - 1);  (a_kc - mean_c) / colour_sigma
struct LobePrior {
  double sigma = 0.5;
  double wall = 30.0;
  double colour_mean[3] = {0.0, 0.0, 0.0};  // of log colours, raw MERL units
  double colour_sigma = 2.0;
};

class LobePriorCost final : public ceres::CostFunction {
 public:
  LobePriorCost(const LobeLayout& layout, const LobePrior& prior);

  // parameters[0] as LobeMixture. Residuals per lobe: codes, wall, colours; of
  // a Lambertian one the colours.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const LobeLayout layout_;
  const LobePrior prior_;
};

// (Phi_i - mean_i) / (sigma std_i): the untrained network's own distribution of
// weights, or any other diagonal Gaussian.
class WeightPriorCost final : public ceres::CostFunction {
 public:
  // mean, std: [num_weights], std > 0.
  WeightPriorCost(std::vector<float> mean, std::vector<float> std,
                  double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const std::vector<float> mean_, std_;
  const double sigma_;
};

}  // namespace ibrdf
