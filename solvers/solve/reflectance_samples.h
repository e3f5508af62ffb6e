// Samples of the posterior of a reflectance.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {

// `count` samples of N(parameters, covariance), each as LobeModel has
// parameters. covariance [n * n], symmetric; what rounding made negative in it
// counts as none. Codes stay in the unit ball. Empty where a value is not
// finite.
std::vector<std::vector<double>> SampleReflectances(
    const LobeModel& lobes, const std::vector<double>& parameters,
    const std::vector<double>& covariance, int count, uint64_t seed);

}  // namespace ibrdf
