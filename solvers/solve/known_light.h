// The reflectance of one material under a known light, by several models.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/solve/other_model.h"

namespace ibrdf {

struct KnownLightEstimate {
  OtherModel other;  // empty: the estimate has the problem's own model
  Estimate estimate;
  // Those that were searched, the estimate's first, and their shares of the
  // evidence, sum 1. Empty where the problem has no other model.
  std::vector<NamedModel> models;
  std::vector<double> model_weights;

  // The setup of the estimate's model; `own` is that of the problem's.
  const SolveSetup& SetupOr(const SolveSetup& own) const {
    return other.setup != nullptr ? *other.setup : own;
  }
};

// The problem's own model comes first. Where what it leaves of the image is not
// noise, its other models are searched too as long as time and iterations
// allow, and the estimate is the mean of their optima (AverageOptima). `setup`
// must outlive the result. Fails where another model has no setup.
StatusOr<KnownLightEstimate> EstimateUnderKnownLight(const SolveSetup& setup,
                                                     SolveContext* context);

}  // namespace ibrdf
