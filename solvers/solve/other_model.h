// One of a problem's models, apart from the others.
#pragma once
#include <memory>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// A problem with another model, and what its stages share.
struct OtherModel {
  std::unique_ptr<const InverseProblem> problem;
  std::unique_ptr<const SolveSetup> setup;
};

// The problem with that model in the place of its own, and no other.
InverseProblem WithModel(NamedModel model, InverseProblem problem);

// Fails as SetUp.
StatusOr<OtherModel> SetUpWith(const NamedModel& model,
                               const InverseProblem& problem);

}  // namespace ibrdf
