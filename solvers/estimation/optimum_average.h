// Local optima that the evidence hardly tells apart, averaged.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/posterior.h"

namespace ibrdf {

// Weights proportional to exp(-cost / T), sum 1, costs in nats. Bins of one
// image do not err independently, as the likelihood has it: T = 20 nats of its
// evidence count as one (docs/notes/averaged_optima.md). Those below a
// hundredth get 0. Empty for no costs; all must be finite.
std::vector<double> OptimumWeights(const std::vector<double>& costs);

struct OptimumAverage {
  size_t model = 0;  // whose lobes the estimate has: that of the least cost
  // Share of the evidence of each model, sum 1.
  std::vector<double> model_weights;
  // That model's estimate, its lobes the nearest to the mean of
  // log(raw BRDF + 1e-6) over the optima of all models. Where one optimum has
  // all the weight it is as it was.
  ReflectanceEstimate estimate;
};

// models: of one search, at least one, each with a gauge where the light is
// unknown. Candidates of no finite cost do not count; where there are no others
// the estimate is the first model's.
OptimumAverage AverageOptima(const std::vector<ModelOptima>& models);

}  // namespace ibrdf
