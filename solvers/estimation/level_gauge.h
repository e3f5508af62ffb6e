// The scale between reflectance and light, which no image tells.
#pragma once
#include <Eigen/Core>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// A reflectance's mean log over the angles is put where that of the prior's
// materials is on average.
//
// A Gaussian of codes and colours says less: shapes between those of the
// materials are far out along its colours too, where the level that it deems
// most probable may be twenty times off.
class LevelGauge {
 public:
  // The prior's materials, at least one, are tabulated here, once.
  LevelGauge(const NeuralBrdfModel& model, const MaterialPrior& prior,
             int num_threads);

  // Adds the same to the log colours of all lobes and channels of `parameters`,
  // a LobeMixture's, and returns it; finite for any finite parameters.
  double Fix(double* parameters) const;

 private:
  double MeanLog(const double* parameters) const;

  const FlowLobes lobes_;
  double mean_ = 0.0;
};

}  // namespace ibrdf
