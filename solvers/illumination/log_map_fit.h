// Parameters of an illumination model that make a given map.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/solvers/illumination/illumination_model.h"

namespace ibrdf {

struct LogMapFitOptions {
  // Standard deviation of log radiance at the equator's texels that counts as a
  // fit; elsewhere in proportion to the root of the solid angle.
  double sigma = 0.2;
  int max_iterations = 12;     // of Gauss-Newton
  int max_cg_iterations = 20;  // in each
  double tolerance = 1e-2;     // relative decrease of the cost to stop at
  std::function<bool()> should_stop;  // between iterations; may be empty
};

// Minimises, from `parameters` in place, which are the mean of the model's
// Gaussian prior,
//   1/2 sum solid angle share (log map - target)^2 / sigma^2 + prior
// by matrix-free Gauss-Newton; target of the model's size. It never rises.
// Returns the cost at the end.
double FitLogMap(const LogMap& target, const LogMapFitOptions& options,
                 IlluminationModel* model, std::vector<float>* parameters);

}  // namespace ibrdf
