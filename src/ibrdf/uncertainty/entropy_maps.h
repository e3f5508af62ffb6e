// Entropy and most probable parameters of the texels of a surface.
#pragma once
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

// [num_texels, 3] each, row = texel, column = channel.
struct EntropyMaps {
  int num_texels = 0;
  // Entropy of the posterior over the grid of parameters, in units of that of
  // a uniform distribution, [0, 1]: Eq. 5 of Wiersma et al. 2025. With a
  // uniform prior, a texel that no view sees has exactly 1.
  std::vector<float> entropy;
  // Most probable parameters; 0 where no view sees the texel. Kd and Ks are in
  // units of what a white matte surface and a perfect mirror reflect.
  std::vector<float> alpha, Ks, Kd;
  // Distance of the best parameters from the observations, as a share of the
  // observations' own size, [0, 1].
  std::vector<float> misfit;
  // The distance that sigma explains: 1 is one standard deviation.
  std::vector<float> deviations;

  void Resize(int texels);

  // Over the three channels, [num_texels]. The published code takes the
  // minimum: one channel is enough to know alpha.
  std::vector<float> MinimumEntropy() const;
  std::vector<float> MeanEntropy() const;
};

// From observations to entropy, by one model or another. Immutable; safe to
// share between threads.
class EntropyEvaluator {
 public:
  virtual ~EntropyEvaluator() = default;

  // num_threads <= 0: all. The result does not depend on it.
  virtual StatusOr<EntropyMaps> Evaluate(const TexelSamples& samples,
                                         int num_threads) const = 0;
};

}  // namespace ibrdf
