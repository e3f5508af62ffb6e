// Distributions that train beside measured ones: a hundred materials leave gaps
// in the embedding.
#pragma once
#include <cstdint>

#include "ibrdf/brdf/disney.h"
#include "ibrdf/solvers/table_fit/table_columns.h"

namespace ibrdf {

// A material of the principled model at random: alpha = roughness^2 uniform in
// logarithm over [0.01, 0.7]; half of them metals with F0 in [0.4, 0.98] per
// channel, half dielectrics with F0 in [0.02, 0.08] and a base uniform in
// logarithm over [0.003, 0.8] per channel.
Disney RandomDisney(uint64_t seed);

// Appends `count` of them, named analytic-000.red and so on, at the columns of
// `data`: materials which no measured one resembles.
void AddAnalyticMaterials(int count, uint64_t seed, TrainingData* data);

}  // namespace ibrdf
