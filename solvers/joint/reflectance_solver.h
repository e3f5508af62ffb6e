// Codes and colours of the lobes for a fixed map: Ceres' trust region on the
// analytic Jacobian.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/priors/ambient_prior.h"
#include "ibrdf/solvers/priors/material_prior.h"
#include "ibrdf/solvers/priors/prior_costs.h"

namespace ibrdf {

struct ReflectanceStepOptions {
  RobustLogLikelihood likelihood;
  LobePrior prior;
  // In place of `prior` where it is not null.
  const MaterialPrior* materials = nullptr;
  // The ambient term's, where it is unknown too; null: it is the likelihood's.
  const AmbientPrior* ambient = nullptr;
  // The operator of the transport and map, where it is at hand; null: made
  // anew.
  const ReflectanceOperator* stored = nullptr;
  int max_iterations = 10;
  double tolerance = 1e-4;  // relative decrease of the cost to stop at
  // The first radius of Ceres' trust region. Few parameters: it may start wide.
  double trust_region_radius = 10.0;
  std::function<bool()> should_stop;
};

// Lowers likelihood + priors from `parameters` in place; it never rises.
// `ambient` [3] >= 0, with options.ambient alone, likewise. Returns the cost at
// the end.
double SolveReflectance(const Transport& transport, const LobeModel& lobes,
                        const std::vector<float>& map,
                        const Observations& observed,
                        const ReflectanceStepOptions& options,
                        std::vector<double>* parameters,
                        Eigen::Array3d* ambient = nullptr);

}  // namespace ibrdf
