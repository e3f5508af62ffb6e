// Entropy of every texel of a surface.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/surface/texel_irradiance.h"
#include "ibrdf/surface/texel_observations.h"
#include "ibrdf/uncertainty/entropy_maps.h"
#include "ibrdf/uncertainty/spectrum_entropy.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

// A row for each texel of the atlas.
struct TexelEntropy {
  EntropyMaps maps;
  std::vector<int> observed_views;        // with a sample of the texel
  std::vector<uint8_t> below_band_limit;  // BelowBandLimit
  std::vector<int> texels_of_view;  // [num_views]: of which it has samples

  int CountObserved() const;
  // The mean over the texels that a view has a sample of, or over all, and over
  // channels. 1 where there is none.
  double MeanEntropy(bool observed_alone) const;
};

// The light that the samples are of.
struct LightScale {
  double mean_radiance = 1.0, prefilter_alpha = 0.0;
  // The irradiance for EvaluateTexels; null: evaluators find the irradiance by
  // themselves.
  const TexelIrradiance* irradiance = nullptr;
};
TexelSamples SamplesOf(TexelObservations observations, const LightScale& light);

// The evaluators with the problem's settings.
std::unique_ptr<EntropyEvaluator> MakeEvaluator(const UncertaintySpec& spec);
SpectrumOptions SpectrumOptionsOf(const UncertaintySpec& spec);

// Called with the share of texels that are done; false: stop.
using TexelProgress = std::function<bool(double share)>;

// Observes and evaluates block by block: memory is that of the views, of one
// block and of the result. Fails with kInterrupted where progress, which may be
// empty, says so.
StatusOr<TexelEntropy> EvaluateTexels(const TexelObserver& observer,
                                      const LightScale& light,
                                      const UncertaintySpec& spec,
                                      int num_threads,
                                      const TexelProgress& progress);

}  // namespace ibrdf
