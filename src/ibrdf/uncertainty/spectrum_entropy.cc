#include "ibrdf/uncertainty/spectrum_entropy.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/uncertainty/parameter_prior.h"
#include "ibrdf/uncertainty/spectrum_kernels.h"

namespace ibrdf {
namespace {

// Signals per piece of work: their planes stay in the cache.
constexpr int kSignals = 2048;
// Squares of differences stay finite in single precision.
constexpr double kLargestSignal = 1e15;

using SpectrumFunction = void (*)(const SpectrumGrid& grid,
                                  const SpectrumSignals& signals);

SpectrumFunction SpectrumKernel() {
#if defined(IBRDF_HAVE_X86_KERNELS)
  switch (ActiveSimdLevel()) {
    case SimdLevel::kAvx512:
      return avx512::SpectrumEntropy;
    case SimdLevel::kAvx2:
      return avx2::SpectrumEntropy;
    case SimdLevel::kPortable:
    case SimdLevel::kDouble:
      break;
  }
#endif
  return portable::SpectrumEntropy;
}

std::vector<float> SinglePrecision(const std::vector<double>& v) {
  return std::vector<float>(v.begin(), v.end());
}

// Planes of a piece of work, and what the kernel makes of them.
struct Piece {
  std::vector<float> incoming, outgoing, entropy, distance;
  std::vector<int32_t> cell;

  explicit Piece(int order)
      : incoming(order * kSignals),
        outgoing(order * kSignals),
        entropy(kSignals),
        distance(kSignals),
        cell(kSignals) {}
};

void FillPiece(const PowerSpectra& spectra, const SpectrumOptions& options,
               int64_t first, int count, Piece* piece) {
  for (int l = 1; l <= spectra.order; ++l) {
    const float* const S_B = &spectra.outgoing[l * spectra.num_signals + first];
    const float* const S_L = &spectra.incoming[l * spectra.num_signals + first];
    const float* const S_B0 = &spectra.outgoing[first];
    float* const A = &piece->incoming[(l - 1) * kSignals];
    float* const B = &piece->outgoing[(l - 1) * kSignals];
    for (int i = 0; i < count; ++i) {
      A[i] = static_cast<float>(
          ComparedSignal(options, l, S_L[i], S_L[i], S_B0[i]));
      B[i] = static_cast<float>(
          ComparedSignal(options, l, S_B[i], S_L[i], S_B0[i]));
    }
  }
}

// The results of a piece into the rows of its texels.
void StorePiece(const Piece& piece, const SpectrumOptions& options,
                int64_t first, int count, EntropyMaps* maps) {
  const std::vector<double> alpha =
      AlphaValues(options.alpha_grid, options.num_alpha);
  const std::vector<double> Ks = UnitValues(options.num_ks);
  for (int i = 0; i < count; ++i) {
    const int64_t signal = first + i;
    const int64_t texel = signal % maps->num_texels;
    const int64_t to = 3 * texel + signal / maps->num_texels;
    double size = 0.0;
    for (int l = 0; l < options.fit.order; ++l) {
      const double B = piece.outgoing[l * kSignals + i];
      size += B * B;
    }
    maps->entropy[to] = piece.entropy[i];
    maps->alpha[to] = static_cast<float>(alpha[piece.cell[i] / options.num_ks]);
    maps->Ks[to] = static_cast<float>(Ks[piece.cell[i] % options.num_ks]);
    maps->misfit[to] =
        size > 0.0 ? static_cast<float>(std::min(1.0, piece.distance[i] / size))
                   : 0.0f;
    maps->deviations[to] = std::sqrt(2.0f * piece.distance[i]);
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
  // Per degree: the published code divides by l + 1, not by 2 l + 1.
  const double per_degree = options.power_per_degree ? 1.0 / (l + 1.0) : 1.0;
  double signal = power ? S * per_degree : std::sqrt(S * per_degree);
  if (options.relative_weights) {
    const double unit = S_L + options.relative_floor;
    signal /= power ? unit : std::sqrt(unit);
  }
  if (options.mean_over_degrees) signal /= std::sqrt(double(options.fit.order));
  if (!options.unit_exposure) signal *= S_B0;
  // Eq. 3: exp(-d / (2 sigma^2)). Amplitudes are those of a mean over the
  // sphere.
  const double variance =
      2.0 * options.sigma * options.sigma * (power ? 1.0 : 4.0 * kPi);
  return std::min(signal / std::sqrt(variance), kLargestSignal);
}

EntropyMaps EntropyOfSpectra(const PowerSpectra& spectra,
                             const SpectrumOptions& options,
                             double prefilter_alpha, int num_threads) {
  CHECK_EQ(spectra.order, options.fit.order);
  CHECK_EQ(0, spectra.num_signals % 3);
  EntropyMaps maps;
  maps.Resize(static_cast<int>(spectra.num_signals / 3));
  const std::vector<float> filter =
      SinglePrecision(FilterTable(options, prefilter_alpha));
  const std::vector<float> factor = SinglePrecision(FactorTable(options));
  const std::vector<float> penalty =
      SinglePrecision(PriorPenalty(options.prior));
  const SpectrumGrid grid{
      options.fit.order, options.num_alpha,
      options.num_ks,    filter.data(),
      factor.data(),     penalty.empty() ? nullptr : penalty.data()};
  ParallelFor((spectra.num_signals + kSignals - 1) / kSignals, num_threads,
              [&](int64_t index, int) {
                const int64_t first = index * kSignals;
                const int count = static_cast<int>(
                    std::min<int64_t>(kSignals, spectra.num_signals - first));
                Piece piece(spectra.order);
                FillPiece(spectra, options, first, count, &piece);
                const SpectrumSignals signals{kSignals,
                                              piece.incoming.data(),
                                              piece.outgoing.data(),
                                              count,
                                              piece.entropy.data(),
                                              piece.distance.data(),
                                              piece.cell.data()};
                SpectrumKernel()(grid, signals);
                StorePiece(piece, options, first, count, &maps);
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
