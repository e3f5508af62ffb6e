// The scale between reflectance and light, which no image tells.
#pragma once
#include "ibrdf/flow/neural_brdf_model.h"
#include "solvers/material_prior.h"

namespace ibrdf {

// What to add to the log colours of all lobes of `parameters` [lobes * (code +
// 3)], all channels alike, so that the BRDF's mean log over the angles is the
// mean of the prior's materials. Finite for any finite parameters.
//
// A Gaussian of codes and colours says less: shapes between those of the
// materials are far out along its colours too, where the level that it deems
// most probable may be twenty times off.
double LevelShift(const NeuralBrdfModel& model, const MaterialPrior& prior,
                  const Eigen::VectorXd& parameters, int num_threads);

}  // namespace ibrdf
