#include "ibrdf/uncertainty/angular_entropy.h"

#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/base/to_float.h"
#include "ibrdf/uncertainty/angular_kernels.h"
#include "ibrdf/uncertainty/cosine_lobe.h"
#include "ibrdf/uncertainty/parameter_prior.h"

namespace ibrdf {
namespace {

constexpr int kBatchSignals = 3 * kFitBatch;
// Distances stay finite in single precision.
constexpr double kLargestDistance = 1e30;
// A determinant below this share of its terms is rounding.
constexpr double kSingular = 1e-10;
// Light whose square is less tells nothing, and quotients by it overflow.
constexpr double kNoLight = 1e-20;

// The mean over views of (y - Kd D - Ks x)^2, as a function of Kd and Ks.
struct Quadratic {
  double yy = 0, xx = 0, xy = 0;  // means of squares and products
  double D = 0, y = 0, x = 0;     // the matte part, and means

  double operator()(double Kd, double Ks) const {
    return yy + Kd * D * (Kd * D - 2.0 * y) +
           Ks * (Ks * xx - 2.0 * xy + 2.0 * Kd * D * x);
  }
  // The best Ks for a Kd, and Kd for a Ks; 0 where any is the best.
  double BestKs(double Kd) const {
    return xx > kNoLight ? (xy - Kd * D * x) / xx : 0.0;
  }
  double BestKd(double Ks) const { return D > 0.0 ? (y - Ks * x) / D : 0.0; }
  bool Separable() const {
    return D > 0.0 && xx > kNoLight && xx - x * x > kSingular * xx;
  }
};

struct Estimate {
  double distance = std::numeric_limits<double>::infinity();
  double Kd = 0.0, Ks = 0.0;
};

// The least of the quadratic on the unit square: inside, or on an edge.
Estimate LeastInSquare(const Quadratic& q) {
  Estimate out;
  const auto offer = [&](double Kd, double Ks) {
    Kd = std::clamp(Kd, 0.0, 1.0);
    Ks = std::clamp(Ks, 0.0, 1.0);
    const double d = std::max(0.0, q(Kd, Ks));
    if (d < out.distance) out = {d, Kd, Ks};
  };
  if (q.Separable()) {
    const double Ks = (q.xy - q.x * q.y) / (q.xx - q.x * q.x);
    const double Kd = q.BestKd(Ks);
    if (Ks >= 0.0 && Ks <= 1.0 && Kd >= 0.0 && Kd <= 1.0) {
      offer(Kd, Ks);
      return out;
    }
  }
  for (const double edge : {0.0, 1.0}) {
    offer(edge, q.BestKs(edge));
    offer(q.BestKd(edge), edge);
  }
  return out;
}

// The rows of the kernel (AngularRow), of a quadratic divided by 2 sigma^2.
std::array<double, kAngularRows> RowsOf(const Quadratic& q, bool with_Kd) {
  std::array<double, kAngularRows> out{};
  if (!with_Kd) {
    // Kd takes the means, where there is a matte part.
    const double mean_x = q.D > 0.0 ? q.x : 0.0, mean_y = q.D > 0.0 ? q.y : 0.0;
    const double rest = q.yy - mean_y * mean_y;
    const double product = q.xy - mean_x * mean_y;
    double square = q.xx - mean_x * mean_x;
    if (!(q.xx > kNoLight && square > kSingular * q.xx)) square = 0.0;
    out[kGloss] = square;
    out[kOffset] = square > 0.0 ? product / square : 0.0;
    out[kRest] = rest - out[kOffset] * product;
    return out;
  }
  if (q.xx > kNoLight) {
    out[kGloss] = q.xx;
    out[kOffset] = q.xy / q.xx;
    out[kSlope] = q.D * q.x / q.xx;
  }
  const double square = q.D * (q.D - out[kSlope] * q.x);
  const double product = q.D * q.y - out[kSlope] * q.xy;
  double rest = q.yy - out[kOffset] * q.xy;
  if (q.D > 0.0 && square > kSingular * q.D * q.D) {
    out[kMatte] = square;
    out[kMatteBest] = product / square;
    rest -= out[kMatteBest] * product;
  }
  out[kRest] = rest;
  return out;
}

// A texture in batches of texels, by one thread.
class AngularBatch {
 public:
  AngularBatch(const AngularOptions& options, const HarmonicFitter& fitter,
               const HarmonicBasis& basis, const TexelSamples& samples)
      : options_(options),
        fitter_(fitter),
        basis_(basis),
        samples_(samples),
        alpha_(AlphaValues(options.alpha_grid, options.num_alpha)),
        lobe_(CosineLobe(basis)),
        coefficients_(basis.count() * kFitValues * kFitBatch),
        moments_(options.num_alpha * 3 * kAngularMoments * kFitBatch),
        rows_(options.num_alpha * kAngularRows * kBatchSignals) {
    for (const double alpha : alpha_) {
      for (int l = 0; l <= basis.order(); ++l) {
        filter_.push_back(FilterOf(options.filter, alpha, l) / Prefilter(l));
      }
    }
    Ks_ = ToFloat(UnitValues(options.num_ks));
    Kd_ = options.num_kd > 0 ? ToFloat(UnitValues(options.num_kd))
                             : std::vector<float>{0.0f};
    penalty_ = ToFloat(PriorPenalty(options.prior));
  }

  void Evaluate(int64_t first, EntropyMaps* maps) {
    GatherBatch(samples_, first, samples_.mean_radiance, &batch_);
    fitter_.Fit(batch_, &workspace_, coefficients_.data());
    Moments();
    const int texels = static_cast<int>(
        std::min<int64_t>(kFitBatch, samples_.num_texels - first));
    for (int lane = 0; lane < texels; ++lane) {
      for (int c = 0; c < 3; ++c) {
        EstimateOf(lane, c, 3 * (first + lane) + c, maps);
      }
    }
    std::array<float, kBatchSignals> entropy;
    const AngularGrid grid{options_.num_alpha,
                           options_.num_ks,
                           static_cast<int>(Kd_.size()),
                           Ks_.data(),
                           Kd_.data(),
                           penalty_.empty() ? nullptr : penalty_.data()};
    const auto kernel = IBRDF_ACTIVE_KERNEL(AngularEntropy);
    kernel(grid, {rows_.data(), kBatchSignals, entropy.data()});
    for (int lane = 0; lane < texels; ++lane) {
      for (int c = 0; c < 3; ++c) {
        maps->entropy[3 * (first + lane) + c] = entropy[c * kFitBatch + lane];
      }
    }
  }

 private:
  double Prefilter(int l) const {
    return options_.undo_prefilter
               ? FilterOf(GlossFilter::kBeckmann, samples_.prefilter_alpha, l)
               : 1.0;
  }

  void Moments() {
    numbers_.resize(
        AngularWorkspaceSize(basis_.order(), batch_.num_views, kMostDoubles));
    AngularArguments a;
    a.batch = batch_.Arguments(basis_);
    a.num_alpha = options_.num_alpha;
    a.filter = filter_.data();
    a.alpha = alpha_.data();
    a.fresnel = options_.fresnel;
    a.masking = options_.masking;
    a.coefficients = coefficients_.data();
    a.workspace = numbers_.data();
    a.moments = moments_.data();
    const auto kernel = IBRDF_ACTIVE_KERNEL(AngularMoments);
    kernel(a);
  }

  // Radiance of a white matte surface: E / pi.
  double Matte(int lane, int channel, int64_t at) const {
    double E = 0.0;
    if (!samples_.irradiance.empty()) {
      E = samples_.irradiance[at] / samples_.mean_radiance;
    } else {
      for (int l = 0; l <= basis_.order(); ++l) {
        E += lobe_[l] / Prefilter(l) *
             coefficients_[(HarmonicIndex(l, 0) * kFitValues + 3 + channel) *
                               kFitBatch +
                           lane];
      }
    }
    return std::isfinite(E) && E > kNoLight ? E / kPi : 0.0;
  }

  // Distances of one channel of a texel, for the kernel, and its estimates.
  void EstimateOf(int lane, int channel, int64_t at, EntropyMaps* maps) {
    double weights = 0.0, square = 0.0;
    for (int view = 0; view < batch_.num_views; ++view) {
      const double w = batch_.weight[view * kFitBatch + lane];
      const double B =
          batch_.values[(view * kFitValues + channel) * kFitBatch + lane];
      weights += w;
      square += w * B * B;
    }
    const double scale = weights > 0.0 ? 1.0 / weights : 0.0;
    const double precision = 0.5 / (options_.sigma * options_.sigma);
    Quadratic q;
    q.D = weights > 0.0 ? Matte(lane, channel, at) : 0.0;
    Estimate best;
    for (int i = 0; i < options_.num_alpha; ++i) {
      const double* const m =
          &moments_[(3 * i + channel) * kAngularMoments * kFitBatch + lane];
      const auto mean = [&](int k) { return m[k * kFitBatch] * scale; };
      q.y = mean(0);
      q.yy = mean(1);
      q.x = mean(2);
      q.xx = mean(3);
      q.xy = mean(4);
      StoreRows(RowsOf(q, options_.num_kd > 0), precision, i,
                channel * kFitBatch + lane);
      const Estimate found = LeastInSquare(q);
      if (found.distance < best.distance) {
        best = found;
        maps->alpha[at] = static_cast<float>(alpha_[i]);
        maps->Ks[at] = static_cast<float>(found.Ks);
        maps->Kd[at] = static_cast<float>(found.Kd);
      }
    }
    square *= scale;
    maps->misfit[at] =
        square > 0.0 ? static_cast<float>(std::min(1.0, best.distance / square))
                     : 0.0f;
    maps->deviations[at] =
        static_cast<float>(std::sqrt(best.distance) / options_.sigma);
  }

  void StoreRows(const std::array<double, kAngularRows>& values,
                 double precision, int i, int signal) {
    for (int k = 0; k < kAngularRows; ++k) {
      const bool scaled = k == kRest || k == kMatte || k == kGloss;
      double value = values[k];
      if (scaled) {
        value = std::clamp(value * precision, 0.0, kLargestDistance);
      }
      rows_[(i * kAngularRows + k) * kBatchSignals + signal] =
          static_cast<float>(value);
    }
  }

  const AngularOptions& options_;
  const HarmonicFitter& fitter_;
  const HarmonicBasis& basis_;
  const TexelSamples& samples_;
  const std::vector<double> alpha_, lobe_;
  std::vector<double> filter_;
  std::vector<float> Ks_, Kd_, penalty_;

  FitBatch batch_;
  HarmonicFitter::Workspace workspace_;
  std::vector<double> coefficients_, moments_, numbers_;
  std::vector<float> rows_;
};

}  // namespace

Status AngularOptions::Check() const {
  IBRDF_RETURN_IF_ERROR(fit.Check());
  for (const auto& [name, count] :
       {std::pair("num_alpha", num_alpha), std::pair("num_ks", num_ks),
        std::pair("num_kd", num_kd == 0 ? 2 : num_kd)}) {
    if (count < 2 || count > 64) {
      return InvalidInput(name, "expected an integer in [2, 64]");
    }
  }
  if (!(sigma > 0.0) || !std::isfinite(sigma)) {
    return InvalidInput("sigma", "expected a finite number > 0");
  }
  return CheckPrior(prior, num_alpha * num_ks);
}

AngularEntropyEvaluator::AngularEntropyEvaluator(AngularOptions options)
    : options_(std::move(options)) {
  CHECK(options_.Check().ok()) << options_.Check().message();
}

StatusOr<EntropyMaps> AngularEntropyEvaluator::Evaluate(
    const TexelSamples& samples, int num_threads) const {
  IBRDF_RETURN_IF_ERROR(samples.Check());
  const HarmonicFitter fitter(options_.fit);
  const HarmonicBasis basis(options_.fit.order);
  EntropyMaps maps;
  maps.Resize(samples.num_texels);
  // Batches per piece of work: their tables serve them all.
  constexpr int kBatches = 16;
  const int64_t piece = kBatches * kFitBatch;
  ParallelFor((samples.num_texels + piece - 1) / piece, num_threads,
              [&](int64_t index, int) {
                AngularBatch batch(options_, fitter, basis, samples);
                const int64_t end =
                    std::min<int64_t>(samples.num_texels, (index + 1) * piece);
                for (int64_t first = index * piece; first < end;
                     first += kFitBatch) {
                  batch.Evaluate(first, &maps);
                }
              });
  return maps;
}

}  // namespace ibrdf
