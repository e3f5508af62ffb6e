#include "ibrdf/uncertainty/harmonic_fit.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/simd_dispatch.h"

namespace ibrdf {
namespace {

// Squares of spectra must stay finite in single precision.
constexpr double kLargestPower = 1e15;

size_t FitWorkspaceSize(int count, int num_views) {
  const size_t padded = RoundUpToTile(count);
  const size_t all = padded + RoundUpToTile(kFitValues);
  return all * (padded + num_views) * kMostDoubles;
}

std::vector<double> Regulariser(const HarmonicFitOptions& options) {
  std::vector<double> out;
  for (int l = 0; l <= options.order; ++l) {
    out.insert(out.end(), 2 * l + 1, options.lambda * std::exp(l));
  }
  out[0] *= options.constant_penalty;
  return out;
}

// One view of a batch; true where it sees one of the texels.
bool GatherView(const TexelSamples& samples, int64_t first, int view,
                float scale, int to, FitBatch* batch) {
  bool seen = false;
  for (int lane = 0; lane < kFitBatch; ++lane) {
    const int64_t texel = first + lane;
    const float weight = texel < samples.num_texels
                             ? UsableWeight(samples, texel, view, scale)
                             : 0.0f;
    const int at = to * kFitBatch + lane;
    batch->weight[at] = weight;
    const bool used = weight > 0.0f;
    seen = seen || used;
    const size_t from =
        used ? 3 * (static_cast<size_t>(texel) * samples.num_views + view) : 0;
    batch->zero[at] = used ? samples.directions[from] : 0.0f;
    batch->side[at] = used ? samples.directions[from + 1] : 0.0f;
    batch->polar[at] = used ? samples.directions[from + 2] : 1.0f;
    float* const values = &batch->values[to * kFitValues * kFitBatch + lane];
    for (int c = 0; c < 3; ++c) {
      values[c * kFitBatch] = used ? samples.outgoing[from + c] * scale : 0.0f;
      values[(c + 3) * kFitBatch] =
          used ? samples.incoming[from + c] * scale : 0.0f;
    }
  }
  return seen;
}

// Adds sum_m c_lm^2 of a batch to the spectra of its texels.
void StorePower(const double* coefficients, int64_t first, int64_t num_texels,
                PowerSpectra* spectra) {
  for (int l = 0; l <= spectra->order; ++l) {
    for (int c = 0; c < kFitValues; ++c) {
      double power[kFitBatch] = {};
      for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
        const double* const x = coefficients + (k * kFitValues + c) * kFitBatch;
        for (int i = 0; i < kFitBatch; ++i) power[i] += x[i] * x[i];
      }
      std::vector<float>& out = c < 3 ? spectra->outgoing : spectra->incoming;
      float* const to =
          &out[l * spectra->num_signals + (c % 3) * num_texels + first];
      const int64_t count = std::min<int64_t>(kFitBatch, num_texels - first);
      for (int64_t i = 0; i < count; ++i) {
        to[i] = static_cast<float>(std::min(power[i], kLargestPower));
      }
    }
  }
}

}  // namespace

Status HarmonicFitOptions::Check() const {
  if (order < 1 || order > 10) {
    return InvalidInput("order", "expected an integer in [1, 10]");
  }
  if (!(lambda > 0.0) || !std::isfinite(lambda)) {
    return InvalidInput("lambda", "expected a finite number > 0");
  }
  if (!(constant_penalty > 0.0 && constant_penalty <= 1.0)) {
    return InvalidInput("constant_penalty", "expected a number in (0, 1]");
  }
  if (!(cosine_power >= 0.0) || !std::isfinite(cosine_power)) {
    return InvalidInput("cosine_power", "expected a finite number >= 0");
  }
  return OkStatus();
}

void GatherBatch(const TexelSamples& samples, int64_t first, double unit,
                 FitBatch* batch) {
  const size_t most = static_cast<size_t>(samples.num_views) * kFitBatch;
  for (std::vector<float>* v :
       {&batch->polar, &batch->zero, &batch->side, &batch->weight}) {
    v->resize(most);
  }
  batch->values.resize(most * kFitValues);
  const float scale = static_cast<float>(1.0 / unit);
  batch->num_views = 0;
  for (int view = 0; view < samples.num_views; ++view) {
    if (GatherView(samples, first, view, scale, batch->num_views, batch)) {
      ++batch->num_views;
    }
  }
}

BatchArguments FitBatch::Arguments(const HarmonicBasis& basis) const {
  return {basis.order(),     basis.diagonal().data(),
          basis.up().data(), basis.down().data(),
          num_views,         polar.data(),
          zero.data(),       side.data(),
          weight.data(),     values.data()};
}

HarmonicFitter::HarmonicFitter(const HarmonicFitOptions& options)
    : options_(options),
      basis_(options.order),
      regulariser_(Regulariser(options)) {
  CHECK(options.Check().ok()) << options.Check().message();
}

void HarmonicFitter::Fit(const FitBatch& batch, Workspace* workspace,
                         double* coefficients) const {
  workspace->numbers.resize(std::max(
      workspace->numbers.size(), FitWorkspaceSize(count(), batch.num_views)));
  FitArguments a;
  a.batch = batch.Arguments(basis_);
  a.regulariser = regulariser_.data();
  a.cosine_power = options_.cosine_power;
  a.workspace = workspace->numbers.data();
  a.coefficients = coefficients;
  const auto kernel = IBRDF_ACTIVE_KERNEL(FitHarmonics);
  kernel(a);
}

SequentialFit::SequentialFit(const HarmonicFitOptions& options,
                             int num_values) {
  CHECK(options.Check().ok()) << options.Check().message();
  const std::vector<double> regulariser = Regulariser(options);
  const int count = static_cast<int>(regulariser.size());
  inverse_ = Eigen::Map<const Eigen::VectorXd>(regulariser.data(), count)
                 .cwiseInverse()
                 .asDiagonal();
  coefficients_ = Eigen::MatrixXd::Zero(count, num_values);
}

// Sherman and Morrison's formula: with g = A^-1 y,
//   A^-1 -= w g g^T / (1 + w y.g),  c += w g (f - y.c) / (1 + w y.g).
void SequentialFit::Add(const Eigen::VectorXd& Y, double weight,
                        const Eigen::VectorXd& values) {
  const Eigen::VectorXd g = inverse_.selfadjointView<Eigen::Lower>() * Y;
  const double gain = weight / (1.0 + weight * Y.dot(g));
  const Eigen::RowVectorXd residual =
      values.transpose() - Y.transpose() * coefficients_;
  coefficients_.noalias() += gain * g * residual;
  inverse_.selfadjointView<Eigen::Lower>().rankUpdate(g, -gain);
}

Eigen::MatrixXd SequentialFit::CoefficientsWith(
    const Eigen::VectorXd& Y, double weight,
    const Eigen::VectorXd& values) const {
  const Eigen::VectorXd g = inverse_.selfadjointView<Eigen::Lower>() * Y;
  const double gain = weight / (1.0 + weight * Y.dot(g));
  const Eigen::RowVectorXd residual =
      values.transpose() - Y.transpose() * coefficients_;
  return coefficients_ + gain * g * residual;
}

PowerSpectra FitPowerSpectra(const TexelSamples& samples,
                             const HarmonicFitOptions& options, double unit,
                             int num_threads) {
  const HarmonicFitter fitter(options);
  PowerSpectra out;
  out.order = options.order;
  out.num_signals = 3 * static_cast<int64_t>(samples.num_texels);
  out.outgoing.resize((options.order + 1) * out.num_signals);
  out.incoming.resize(out.outgoing.size());
  // Batches per piece of work: a workspace serves them all.
  constexpr int kBatches = 16;
  const int64_t piece = kBatches * kFitBatch;
  ParallelFor(
      (samples.num_texels + piece - 1) / piece, num_threads,
      [&](int64_t index, int) {
        FitBatch batch;
        HarmonicFitter::Workspace workspace;
        std::vector<double> coefficients(fitter.count() * kFitValues *
                                         kFitBatch);
        const int64_t end =
            std::min<int64_t>(samples.num_texels, (index + 1) * piece);
        for (int64_t first = index * piece; first < end; first += kFitBatch) {
          GatherBatch(samples, first, unit, &batch);
          fitter.Fit(batch, &workspace, coefficients.data());
          StorePower(coefficients.data(), first, samples.num_texels, &out);
        }
      });
  return out;
}

}  // namespace ibrdf
