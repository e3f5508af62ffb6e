// Turns of reflectance and light after a joint search.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// The search bins pixels by normals into few bins and has a light of few
// texels. In these a mirror of one degree and one of five differ by the noise
// that light inside texels makes. Once there is a map of the problem's size,
// the pixels tell them apart: the reflectance is found anew under that map, and
// a map under that reflectance, solver.turns times at most, as long as the
// image is explained better and the time allows. Where what is left of the
// image is noise, nothing is tried. What the search says of the posterior
// stays.
//
// estimate: of an unknown reflectance and light, as EstimateLight gives it;
// gauge: of the setup's materials.
StatusOr<Estimate> TakeJointTurns(const SolveSetup& setup,
                                  const LevelGauge& gauge, Estimate estimate,
                                  SolveContext* context);

// Of the log residuals of pixels beside each other, in [-1, 1]: 0 of noise.
double ResidualCorrelation(const SolveSetup& setup, const Estimate& estimate);

}  // namespace ibrdf
