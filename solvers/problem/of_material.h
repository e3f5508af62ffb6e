// One material of a labelled object by itself.
#pragma once
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// The problem with the points of a material alone. They still see the whole
// object: what hides their light, and its radiosity patches.
InverseProblem OfMaterial(const InverseProblem& problem, int material);

}  // namespace ibrdf
