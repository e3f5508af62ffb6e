// Codes and colours of the lobes for a fixed map: Ceres' trust region on the
// analytic Jacobian.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/priors/material_prior.h"
#include "ibrdf/solvers/priors/prior_costs.h"

namespace ibrdf {

struct ReflectanceStepOptions {
  RobustLogLikelihood likelihood;
  LobePrior prior;
  // In place of `prior` where it is not null.
  const MaterialPrior* materials = nullptr;
  // Of the transport and map, where it is at hand; null: made anew.
  const ReflectanceOperator* stored = nullptr;
  int max_iterations = 10;
  double tolerance = 1e-4;  // relative decrease of the cost to stop at
  // Of Ceres' trust region. Few parameters: it may start wide.
  double trust_region_radius = 10.0;
  std::function<bool()> should_stop;
};

// Lowers likelihood + prior from `parameters` in place; it never rises.
// Returns the cost at the end.
double SolveReflectance(const Transport& transport, const LobeModel& lobes,
                        const std::vector<float>& map,
                        const Observations& observed,
                        const ReflectanceStepOptions& options,
                        std::vector<double>* parameters);

// The gauge (s R, L / s), one s per channel, leaves the image as it is and is
// fixed by the colours' prior and by natural light being nearly grey:
// minimises, over shifts d_c of the lobes' log colours (and -d_c of the map's
// log radiance), the prior of the colours plus
// 1/2 sum_{c != green} ((m_c - d_c) - (m_green - d_green))^2 / light_std^2,
// m_c the map's mean log radiance. Returns d.
std::vector<double> GaugeShift(const LobeModel& lobes, const LobePrior& prior,
                               const std::vector<double>& parameters,
                               const double* mean_log_radiance,
                               double light_std);

}  // namespace ibrdf
