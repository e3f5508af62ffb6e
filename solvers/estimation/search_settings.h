// What every search for a reflectance with the light integrated out is given,
// and what it says of the light.
#pragma once
#include <vector>

#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"

namespace ibrdf {

// A search that spends at most a share of the time that remains.
ReflectanceSearchOptions SearchOptions(double share, const SolveSetup& setup,
                                       SolveContext* context);

// The same that ends at the coarse resolution: neither its finer stages nor the
// object's own light, and no covariance.
ReflectanceSearchOptions CoarseSearchOptions(double share,
                                             const SolveSetup& setup,
                                             SolveContext* context);

// The pixels with radiance 0, which a search leaves out, where it is far below
// any measurement.
Observations SearchedPixels(const SolveSetup& setup);

// What a search says of the light, whose log radiance is to fall by `level`.
LightPosterior LightOf(const ReflectanceSearchResult& found, double level);

}  // namespace ibrdf
