#include "ibrdf/uncertainty/spectrum_entropy.h"

#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/base/to_float.h"
#include "ibrdf/uncertainty/parameter_prior.h"
#include "ibrdf/uncertainty/spectrum_kernels.h"

namespace ibrdf {
namespace {

// Texels per piece of work, one channel at a time.
constexpr int kTexelsPerPiece = 2048;

// What ComparedSignal multiplies S_L and S_B of degree l with that does not
// depend on them.
double ScaleOfDegree(const SpectrumOptions& options, int l) {
  const bool power = options.distance == SpectrumDistance::kPower;
  // Per degree: the published code divides by l + 1, not by 2 l + 1.
  const double per_degree = options.power_per_degree ? 1.0 / (l + 1.0) : 1.0;
  double scale = power ? per_degree : std::sqrt(per_degree);
  if (options.mean_over_degrees) scale /= std::sqrt(double(options.fit.order));
  // Eq. 3: exp(-d / (2 sigma^2)). Amplitudes are those of a mean over the
  // sphere.
  const double variance =
      2.0 * options.sigma * options.sigma * (power ? 1.0 : 4.0 * kPi);
  return scale / std::sqrt(variance);
}

// Everything that all pieces of work share, as the kernel takes it.
struct SpectrumTables {
  std::vector<float> filter, factor, penalty, scale, alpha, Ks;
  SpectrumGrid grid;

  SpectrumTables(const SpectrumOptions& options, double prefilter_alpha)
      : filter(ToFloat(FilterTable(options, prefilter_alpha))),
        factor(ToFloat(FactorTable(options))),
        penalty(ToFloat(PriorPenalty(options.prior))),
        alpha(ToFloat(AlphaValues(options.alpha_grid, options.num_alpha))),
        Ks(ToFloat(UnitValues(options.num_ks))) {
    for (int l = 1; l <= options.fit.order; ++l) {
      scale.push_back(static_cast<float>(ScaleOfDegree(options, l)));
    }
    grid = {options.fit.order, options.num_alpha,
            options.num_ks,    filter.data(),
            factor.data(),     penalty.empty() ? nullptr : penalty.data()};
  }
  SpectrumTables(const SpectrumTables&) = delete;
};

// Texels [first, first + count) of a channel, into the rows of the maps.
void EvaluatePiece(const PowerSpectra& spectra, const SpectrumOptions& options,
                   const SpectrumTables& tables, int channel, int first,
                   int count, EntropyMaps* maps) {
  std::array<float, kTexelsPerPiece> entropy, distance, misfit;
  std::array<int32_t, kTexelsPerPiece> cell;
  const int64_t from = static_cast<int64_t>(channel) * maps->num_texels + first;
  const SpectrumScale scale{
      options.distance == SpectrumDistance::kAmplitude,
      options.relative_weights ? static_cast<float>(options.relative_floor)
                               : 0.0f,
      tables.scale.data(),
      options.unit_exposure ? nullptr : &spectra.outgoing[from]};
  const auto kernel = IBRDF_ACTIVE_KERNEL(SpectrumEntropy);
  kernel(tables.grid, scale,
         {spectra.num_signals, &spectra.incoming[spectra.num_signals + from],
          &spectra.outgoing[spectra.num_signals + from], count, entropy.data(),
          distance.data(), misfit.data(), cell.data()});
  for (int i = 0; i < count; ++i) {
    const size_t to = 3 * (static_cast<size_t>(first) + i) + channel;
    maps->entropy[to] = entropy[i];
    maps->alpha[to] = tables.alpha[cell[i] / options.num_ks];
    maps->Ks[to] = tables.Ks[cell[i] % options.num_ks];
    maps->misfit[to] = misfit[i];
    maps->deviations[to] = std::sqrt(2.0f * distance[i]);
  }
}

}  // namespace

// In the published code: alpha squared, no prefilter undone, sums over l + 1,
// the mean over degrees, distances times S_B(0)^2.
SpectrumOptions SpectrumOptions::Published(double denominator) {
  SpectrumOptions out;
  out.fit.constant_penalty = 1.0;
  out.filter = GlossFilter::kBeckmann;
  out.distance = SpectrumDistance::kPower;
  out.sigma = std::sqrt(0.5 * denominator);
  out.unit_exposure = false;
  out.undo_prefilter = false;
  out.power_per_degree = true;
  out.mean_over_degrees = true;
  return out;
}

Status SpectrumOptions::Check() const {
  IBRDF_RETURN_IF_ERROR(fit.Check());
  for (const auto& [name, count] :
       {std::pair("num_alpha", num_alpha), std::pair("num_ks", num_ks)}) {
    if (count < 2 || count > kMostGridValues) {
      return InvalidInput(name, "expected an integer in [2, 256]");
    }
  }
  if (!(sigma > 0.0) || !std::isfinite(sigma)) {
    return InvalidInput("sigma", "expected a finite number > 0");
  }
  if (!(relative_floor > 0.0) || !std::isfinite(relative_floor)) {
    return InvalidInput("relative_floor", "expected a finite number > 0");
  }
  return CheckPrior(prior, num_alpha * num_ks);
}

std::vector<double> FilterTable(const SpectrumOptions& options,
                                double prefilter_alpha) {
  std::vector<double> out;
  for (const double alpha :
       AlphaValues(options.alpha_grid, options.num_alpha)) {
    for (int l = 1; l <= options.fit.order; ++l) {
      double e = FilterOf(options.filter, alpha, l);
      if (options.undo_prefilter) {
        e /= FilterOf(GlossFilter::kBeckmann, prefilter_alpha, l);
      }
      out.push_back(options.distance == SpectrumDistance::kPower ? e * e : e);
    }
  }
  return out;
}

std::vector<double> FactorTable(const SpectrumOptions& options) {
  std::vector<double> out = UnitValues(options.num_ks);
  if (options.distance == SpectrumDistance::kPower) {
    for (double& k : out) k *= k;
  }
  return out;
}

double ComparedSignal(const SpectrumOptions& options, int l, double S,
                      double S_L, double S_B0) {
  const bool power = options.distance == SpectrumDistance::kPower;
  double signal = (power ? S : std::sqrt(S)) * ScaleOfDegree(options, l);
  if (options.relative_weights) {
    const double unit = S_L + options.relative_floor;
    signal /= power ? unit : std::sqrt(unit);
  }
  if (!options.unit_exposure) signal *= S_B0;
  return std::min(signal, double{kLargestSignal});
}

EntropyMaps EntropyOfSpectra(const PowerSpectra& spectra,
                             const SpectrumOptions& options,
                             double prefilter_alpha, int num_threads) {
  CHECK_EQ(spectra.order, options.fit.order);
  CHECK_EQ(0, spectra.num_signals % 3);
  EntropyMaps maps;
  maps.Resize(static_cast<int>(spectra.num_signals / 3));
  const SpectrumTables tables(options, prefilter_alpha);
  const int texels = maps.num_texels;
  const int pieces = (texels + kTexelsPerPiece - 1) / kTexelsPerPiece;
  ParallelFor(pieces, num_threads, [&](int64_t index, int) {
    const int first = static_cast<int>(index) * kTexelsPerPiece;
    const int count = std::min(kTexelsPerPiece, texels - first);
    for (int c = 0; c < 3; ++c) {
      EvaluatePiece(spectra, options, tables, c, first, count, &maps);
    }
  });
  return maps;
}

SpectrumEntropyEvaluator::SpectrumEntropyEvaluator(SpectrumOptions options)
    : options_(std::move(options)) {
  CHECK(options_.Check().ok()) << options_.Check().message();
}

StatusOr<EntropyMaps> SpectrumEntropyEvaluator::Evaluate(
    const TexelSamples& samples, int num_threads) const {
  IBRDF_RETURN_IF_ERROR(samples.Check());
  const double unit = options_.unit_exposure ? samples.mean_radiance : 1.0;
  const PowerSpectra spectra =
      FitPowerSpectra(samples, options_.fit, unit, num_threads);
  return EntropyOfSpectra(spectra, options_, samples.prefilter_alpha,
                          num_threads);
}

}  // namespace ibrdf
