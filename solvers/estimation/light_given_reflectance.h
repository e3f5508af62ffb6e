// The light given the reflectance: the map of highest posterior probability.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// The map by the prior that the problem asks for:
//   process  MAP estimate under the Gaussian process
//   unet     from there, as the network's output, which is kept where it
//            explains the image as well (Ulyanov et al. 2018)
//   none     free texels
StatusOr<Estimate> EstimateLight(const SolveSetup& setup,
                                 ReflectanceEstimate reflectance,
                                 SolveContext* context);

// The reflectance under a constant map that gives the image its level: what
// there is to say of an image that no search explains.
Estimate ConstantLight(const SolveSetup& setup,
                       ReflectanceEstimate reflectance);

}  // namespace ibrdf
