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

// Cuts the stages short as solver.max_iterations asks for; 0: the initial guess
// is kept.
void LimitIterations(int max_iterations, ReflectanceSearchOptions* options);

// A resolution of a search for the problem as if it had so many photographs:
// what the object hides of the light, the level of the quadrature, and bins,
// which several views share.
void AdaptResolution(const InverseProblem& problem, size_t views,
                     MarginalResolution* resolution);

// SearchedModel::bounce_gain of a search whose finest resolution this is; empty
// where the object throws no light on itself. The setup must outlive it.
BounceGain BounceGainOf(const SolveSetup& setup,
                        const MarginalResolution& fine);

// SearchOptions of one that ends at the coarse resolution, without covariance.
ReflectanceSearchOptions CoarseSearchOptions(double share,
                                             const SolveSetup& setup,
                                             SolveContext* context);

// The pixels with radiance 0, which a search leaves out, where it is far below
// any measurement or they may show several materials.
Observations SearchedPixels(const SolveSetup& setup);

// What a search says of the light, whose log radiance is to fall by `level`.
LightPosterior LightOf(const ReflectanceSearchResult& found, double level);

}  // namespace ibrdf
