// The sweeps: each varies one axis and adds the errors of the library and of
// the naive float code, both against long double.
#pragma once
#include "experiments/validation/stability/sweep_table.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {
namespace stability {

struct SweepOptions {
  unsigned seed = 1;
  int seeds = 5;  // images of each noise
};

// One texel of the map R times the mean of the others; the image's units.
void SweepRange(const NeuralBrdfModel& model, const SweepOptions& options,
                SweepTable* table);
void SweepUnits(const NeuralBrdfModel& model, const SweepOptions& options,
                SweepTable* table);
// Additive noise, and pixels that are wrong altogether.
void SweepNoise(const NeuralBrdfModel& model, const SweepOptions& options,
                SweepTable* table);
void SweepOutliers(const NeuralBrdfModel& model, const SweepOptions& options,
                   SweepTable* table);
// Cook and Torrance's roughness.
void SweepRoughness(const SweepOptions& options, SweepTable* table);
// Norm of the code.
void SweepCodeNorm(const NeuralBrdfModel& model, const SweepOptions& options,
                   SweepTable* table);

}  // namespace stability
}  // namespace ibrdf
