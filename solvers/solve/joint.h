// Reflectance and light of one material, both unknown.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// The light integrated out gives the reflectance: the mean of the local optima
// of all models of the problem. The light is the most probable one given it.
// The lobes of the solution are of the first of its `models`.
StatusOr<Solution> SolveJoint(const SolveSetup& setup, SolveContext* context);

// The model that a solution's lobes are of.
NamedModel ModelOf(const InverseProblem& problem, const Solution& solution);
// The problem with that model in the place of its own, and no other.
InverseProblem WithModelOf(const Solution& solution, InverseProblem problem);

}  // namespace ibrdf
