// The map for a fixed BRDF, by Gauss-Newton or L-BFGS of the joint estimate
// with the reflectance known.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/render/transport.h"
#include "solvers/costs/log_radiance_cost.h"
#include "solvers/illumination_model.h"

namespace ibrdf {

// 1/2 |(Phi - mean) / (sigma std)|^2 on the parameters, and EdgePrior on the
// map; edge_scale 0 turns that off.
struct IlluminationPriorOptions {
  double weight_sigma = 1.0;
  double edge_scale = 1.0;
  double edge_delta = 0.3;
};

struct IlluminationStepOptions {
  RobustLogLikelihood likelihood;
  IlluminationPriorOptions prior;
  int max_iterations = 5;      // of Gauss-Newton or L-BFGS
  int max_cg_iterations = 20;  // in each
  double tolerance = 1e-4;     // relative decrease of the cost to stop at
  bool lbfgs = false;
  // Checked between iterations; true ends early with the best so far.
  std::function<bool()> should_stop;
};

struct IlluminationCost {
  double likelihood = 0.0;  // sum of rho
  double prior = 0.0;
  double total() const { return likelihood + prior; }
};

// The objective at `parameters`; E (may be null) receives the radiance. NaN if
// the radiance is not finite.
IlluminationCost EvaluateIllumination(
    const LightOperator& light, const Observations& observed,
    const IlluminationStepOptions& options,
    const std::vector<float>& prior_mean, const float* parameters,
    IlluminationModel* model, std::vector<double>* E, std::vector<float>* map);

// Lowers the objective from `parameters` in place; it never rises. Returns the
// cost at the end.
IlluminationCost SolveIllumination(const LightOperator& light,
                                   const Observations& observed,
                                   const IlluminationStepOptions& options,
                                   const std::vector<float>& prior_mean,
                                   IlluminationModel* model,
                                   std::vector<float>* parameters);

}  // namespace ibrdf
