// The scale between reflectance and light, (s R, L / s), by what the light is.
#pragma once
#include <Eigen/Core>

#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/estimation/inverse_rendering.h"

namespace ibrdf {

// Log scales d by channel: with exp(d) R and exp(-d) L in the places of R and L
// the gauge holds (problem.h). `map`: L, as the priors have it. 0 where its
// mean radiance is not positive and finite in every channel.
Eigen::Array3d LightGaugeShift(SolverGauge gauge, const Image& map);

// Moves that from the map of a joint estimate to its lobes and table.
void SetGauge(SolverGauge gauge, int num_lobes, Solution* estimate);

}  // namespace ibrdf
