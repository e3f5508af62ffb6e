// Where a reflectance's estimate under known light begins.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

struct RankedMaterial {
  std::string name;
  double cost = 0.0;               // likelihood + prior, nats
  std::vector<double> parameters;  // colours at the image's level
};

// The prior's materials by posterior, best first, each with its colours moved,
// channel by channel, to the image's mean log radiance: all are rendered under
// the map [H, W, 3] at once.
std::vector<RankedMaterial> RankUnderKnownLight(
    const Transport& transport, const LobeModel& lobes,
    const MaterialPrior& prior, const std::vector<float>& map,
    const Observations& observed, const RobustLogLikelihood& likelihood);

}  // namespace ibrdf
