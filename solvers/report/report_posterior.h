// How well reflectance and light are known.
#pragma once
#include <string>

#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// A <section>; empty where the reflectance was known.
std::string PosteriorSection(const InverseProblem& inverse,
                             const Solution& solution);

// The same of the light; empty where it was known.
std::string LightPosteriorSection(const Solution& solution);

}  // namespace ibrdf
