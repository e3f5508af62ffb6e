// Entropy from radiance itself: the angular evaluator.
#pragma once
#include <vector>

#include "ibrdf/uncertainty/entropy_maps.h"
#include "ibrdf/uncertainty/harmonic_fit.h"
#include "ibrdf/uncertainty/reflection_filter.h"

namespace ibrdf {

// Wiersma et al. 2025, Eq. 20 to 25, at every view w:
//   B(w) = Kd E / pi + F(theta) G(theta) [S_alpha * L](w),
//   F = Ks + (1 - Ks) (1 - cos(theta))^5.
// Kd is an albedo: the text has Kd E, the published code (1 - m) Kd E / pi.
// The convolution is that of the harmonic fit to the light. Given alpha, B is
// linear in (Kd, Ks), so that five sums over the views give the distance of
// every (Kd, Ks): views are visited once an alpha. The published code has no
// such evaluator; the text compares it with renders.
struct AngularOptions {
  HarmonicFitOptions fit;
  int num_alpha = 8;  // [2, 64]
  int num_ks = 8;     // [2, 64]
  // Values of Kd, [2, 64]; 0: entropy is that of (alpha, Ks), and Kd is the
  // best one for each, of any size.
  int num_kd = 8;
  AlphaGrid alpha_grid = AlphaGrid::kUniformRoughness;
  GlossFilter filter = GlossFilter::kGgx;
  bool fresnel = true;  // false: F = Ks
  bool masking = true;  // false: G = 1
  bool undo_prefilter = true;

  // Standard deviation of radiance at a view, in units of the map's mean
  // radiance: p is proportional to exp(-d / (2 sigma^2)) (Eq. 3), where d is
  // the *mean* of squares over views. The errors of a model that is too simple
  // do not average out, so that more views of the same are no more certain.
  double sigma = 0.07;
  // p(alpha, Ks) [num_alpha, num_ks], > 0, in any unit; empty: uniform.
  std::vector<double> prior;

  Status Check() const;
};

class AngularEntropyEvaluator final : public EntropyEvaluator {
 public:
  // options: as they pass Check().
  explicit AngularEntropyEvaluator(AngularOptions options);

  // alpha, Ks and Kd are those of the least distance with Ks and Kd in [0, 1],
  // not of a cell.
  StatusOr<EntropyMaps> Evaluate(const TexelSamples& samples,
                                 int num_threads) const override;

 private:
  const AngularOptions options_;
};

}  // namespace ibrdf
