// How far a posterior lets a BRDF's slices move.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/solvers/estimation/brdf_slice.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {

// Three slices with the interval from the 5th to the 95th percentile of `count`
// samples of N(parameters, covariance), at each angle by itself: over theta_h
// at theta_d = 0 and 45 degrees, and over theta_d at theta_h = 0, all at phi_d
// = 90 degrees. Empty where no sample is finite.
std::vector<BrdfSlice> ReflectanceBand(const LobeFactory& lobes,
                                       const std::vector<double>& parameters,
                                       const std::vector<double>& covariance,
                                       int count, uint64_t seed,
                                       const LobeDistance* level = nullptr);

}  // namespace ibrdf
