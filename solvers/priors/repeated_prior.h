// What is known of several materials before an image is seen.
#pragma once
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// `count` materials, each with the prior `one` and independent of the others:
// parameters one after the other, a block-diagonal covariance. Without
// materials to start from.
MaterialPrior RepeatPrior(const MaterialPrior& one, int count);

}  // namespace ibrdf
