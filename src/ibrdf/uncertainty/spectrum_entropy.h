// Entropy from power spectra: the evaluator of Wiersma et al. 2025.
#pragma once
#include <vector>

#include "ibrdf/uncertainty/entropy_maps.h"
#include "ibrdf/uncertainty/harmonic_fit.h"
#include "ibrdf/uncertainty/reflection_filter.h"

namespace ibrdf {

// What is compared, by degree l.
enum class SpectrumDistance {
  // S_B - Ks^2 e^2 S_L: Eq. 11.
  kPower,
  // sqrt(S_B) - Ks e sqrt(S_L). The sum of its squares is linear in radiance,
  // as errors of images are. It is the least mean square, times 4 pi, between
  // two signals of such spectra.
  kAmplitude,
};

// The defaults differ from the published code, each for the reason at the
// option. Published() has all of its forms.
struct SpectrumOptions {
  HarmonicFitOptions fit;
  int num_alpha = 8;  // [2, 256]
  int num_ks = 8;     // [2, 256]
  AlphaGrid alpha_grid = AlphaGrid::kUniformRoughness;
  GlossFilter filter = GlossFilter::kGgx;
  SpectrumDistance distance = SpectrumDistance::kAmplitude;

  // Standard deviation of what is compared (Eq. 3), in units of the map's mean
  // radiance, or of its square with kPower. > 0. Chosen by correlation with
  // brute force on maps of its own (experiments/entropy).
  double sigma = 0.05;

  // True: radiance is taken in units of the map's mean, so that the exposure
  // does not matter. The published code takes radiance as it is, and multiplies
  // distances by S_B(0)^2, though its comment says "normalize": a loss like
  // radiance^8. The text, Eq. 11, has no such factor.
  bool unit_exposure = true;
  // The map was smoothed before L was fitted, the surface saw the sharp one:
  // true divides the filter by exp(-(prefilter_alpha l)^2). The published
  // entropy does not.
  bool undo_prefilter = true;
  // Distances in units of S_L(l) + relative_floor at each degree, or of its
  // root with kAmplitude: relative errors of the spectrum. Not in the text.
  bool relative_weights = false;
  double relative_floor = 0.01;
  // S(l) over l + 1, as the published code has it. Eq. 8 is the sum alone.
  bool power_per_degree = false;
  // The mean over degrees, as in the published code. Eq. 11 is the sum.
  bool mean_over_degrees = false;
  // p(psi) of Eq. 2 [num_alpha, num_ks], > 0, in any unit; empty: uniform.
  std::vector<double> prior;

  // The published code, with the denominator of its exponent, which is
  // 2 sigma^2: 1e-5 or 1e-4 there.
  static SpectrumOptions Published(double denominator);

  Status Check() const;
};

// Entropy, alpha and Ks from spectra. spectra.order: that of options.fit.
// prefilter_alpha: as in TexelSamples. Kd stays 0.
EntropyMaps EntropyOfSpectra(const PowerSpectra& spectra,
                             const SpectrumOptions& options,
                             double prefilter_alpha, int num_threads);

// Harmonic fits, spectra, entropy.
class SpectrumEntropyEvaluator final : public EntropyEvaluator {
 public:
  // options: as they pass Check().
  explicit SpectrumEntropyEvaluator(SpectrumOptions options);

  StatusOr<EntropyMaps> Evaluate(const TexelSamples& samples,
                                 int num_threads) const override;

 private:
  const SpectrumOptions options_;
};

// The filter [num_alpha, order], row = alpha, of degrees 1 to fit.order as
// distances take it: squared with kPower, with the prefilter undone.
std::vector<double> FilterTable(const SpectrumOptions& options,
                                double prefilter_alpha);

// k [num_ks]: Ks, or its square with kPower.
std::vector<double> FactorTable(const SpectrumOptions& options);

// What spectra are multiplied with before their differences are squared: A or
// B of degree l >= 1 from power S, given that of the light and S_B(0).
double ComparedSignal(const SpectrumOptions& options, int l, double S,
                      double S_L, double S_B0);

}  // namespace ibrdf
