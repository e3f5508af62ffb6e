#include "ibrdf/uncertainty/best_view.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/base/to_float.h"
#include "ibrdf/uncertainty/expected_entropy_kernels.h"
#include "ibrdf/uncertainty/parameter_prior.h"

namespace ibrdf {
namespace {

// Texels whose sums are joined before all others are.
constexpr int kTexelsPerSum = 16;

double UnitOf(const TexelSamples& samples, const SpectrumOptions& options) {
  return options.unit_exposure ? samples.mean_radiance : 1.0;
}

// A sample as SequentialFit takes it.
struct Sample {
  Eigen::VectorXd Y, outgoing, incoming;
  double weight = 0.0;
};

Sample SampleOf(const TexelSamples& samples, const HarmonicBasis& basis,
                const SpectrumOptions& options, int texel, int view) {
  Sample out;
  const float scale = static_cast<float>(1.0 / UnitOf(samples, options));
  const size_t at = 3 * (static_cast<size_t>(texel) * samples.num_views + view);
  out.weight = UsableWeight(samples, texel, view, scale);
  if (!(out.weight > 0.0)) return out;
  const float* const w = &samples.directions[at];
  out.Y.resize(basis.count());
  basis.Evaluate({w[1], w[2], w[0]}, out.Y.data());
  out.weight *= std::pow(w[2], options.fit.cosine_power);
  out.outgoing.resize(3);
  out.incoming.resize(3);
  for (int c = 0; c < 3; ++c) {
    out.outgoing[c] = samples.outgoing[at + c] * scale;
    out.incoming[c] = samples.incoming[at + c] * scale;
  }
  return out;
}

double PowerOf(const Eigen::Ref<const Eigen::VectorXd>& c, int l) {
  return c.segment(l * l, 2 * l + 1).squaredNorm();
}

}  // namespace

Status BestViewOptions::Check() const {
  IBRDF_RETURN_IF_ERROR(spectrum.Check());
  if (trusted_views < 0) {
    return InvalidInput("trusted_views", "expected an integer >= 0");
  }
  return OkStatus();
}

BestViewSearch::BestViewSearch(const TexelSamples& candidates,
                               BestViewOptions options, int num_threads)
    : candidates_(candidates),
      options_(std::move(options)),
      num_threads_(num_threads),
      basis_(options_.spectrum.fit.order) {
  CHECK(options_.Check().ok()) << options_.Check().message();
  CHECK(candidates.Check().ok()) << candidates.Check().message();
  const SpectrumOptions& spectrum = options_.spectrum;
  filter_ = ToFloat(FilterTable(spectrum, candidates.prefilter_alpha));
  SpectrumOptions shown = spectrum;
  if (options_.published_alpha) shown.alpha_grid = AlphaGrid::kUniformAlpha;
  hypothetical_ = ToFloat(FilterTable(shown, candidates.prefilter_alpha));
  factor_ = ToFloat(FactorTable(spectrum));
  penalty_ = ToFloat(PriorPenalty(spectrum.prior));
  // What k shows has S_B(0) = Ks^2 S_L(0), where distances depend on it.
  for (const double Ks : UnitValues(spectrum.num_ks)) {
    scale_.push_back(
        spectrum.unit_exposure ? 1.0f : static_cast<float>(std::pow(Ks, 4)));
  }
  observed_.assign(candidates.num_texels, SequentialFit(spectrum.fit, 6));
  light_.assign(candidates.num_texels, SequentialFit(spectrum.fit, 3));
}

void BestViewSearch::Add(int view, bool photographed) {
  CHECK(view >= 0 && view < candidates_.num_views);
  taken_.push_back(view);
  if (photographed) ++num_photographed_;
  ParallelFor(candidates_.num_texels, num_threads_, [&](int64_t texel, int) {
    const Sample sample =
        SampleOf(candidates_, basis_, options_.spectrum, texel, view);
    if (!(sample.weight > 0.0)) return;
    light_[texel].Add(sample.Y, sample.weight, sample.incoming);
    if (!photographed) return;
    Eigen::VectorXd both(6);
    both << sample.outgoing, sample.incoming;
    observed_[texel].Add(sample.Y, sample.weight, both);
  });
}

// Eq. 4 from the photographs.
std::vector<float> BestViewSearch::Probabilities(int texel, int channel) const {
  const SpectrumOptions& options = options_.spectrum;
  const int cells = options.num_alpha * options.num_ks;
  if (num_photographed_ < options_.trusted_views) {
    return std::vector<float>(cells, 1.0f / static_cast<float>(cells));
  }
  const Eigen::MatrixXd& c = observed_[texel].coefficients();
  const double S_B0 = PowerOf(c.col(channel), 0);
  std::vector<double> distance(cells, 0.0);
  for (int l = 1; l <= options.fit.order; ++l) {
    const double S_L = PowerOf(c.col(3 + channel), l);
    const double A = ComparedSignal(options, l, S_L, S_L, S_B0);
    const double B =
        ComparedSignal(options, l, PowerOf(c.col(channel), l), S_L, S_B0);
    for (int k = 0; k < cells; ++k) {
      const int i = k / options.num_ks, j = k % options.num_ks;
      const double r =
          factor_[j] * filter_[i * options.fit.order + l - 1] * A - B;
      distance[k] += r * r;
    }
  }
  for (int k = 0; k < cells && !penalty_.empty(); ++k) {
    distance[k] += penalty_[k];
  }
  const double least = *std::min_element(distance.begin(), distance.end());
  double sum = 0.0;
  for (double& x : distance) sum += x = std::exp(least - x);
  std::vector<float> out;
  for (const double x : distance) out.push_back(static_cast<float>(x / sum));
  return out;
}

// Adds to sums [num_views] what to expect of one texel, all channels. Views
// that do not see it leave it as it is.
void BestViewSearch::AddExpected(int texel, double* sums) const {
  const SpectrumOptions& options = options_.spectrum;
  const int order = options.fit.order, num_views = candidates_.num_views;
  const int stride = num_views + 1;  // the last: no view is added
  std::vector<float> signals(3 * order * stride);
  std::vector<int> seeing;
  const auto store = [&](const Eigen::MatrixXd& c, int to) {
    for (int channel = 0; channel < 3; ++channel) {
      const double S_L0 = PowerOf(c.col(channel), 0);
      for (int l = 1; l <= order; ++l) {
        const double S_L = PowerOf(c.col(channel), l);
        signals[(channel * order + l - 1) * stride + to] =
            static_cast<float>(ComparedSignal(options, l, S_L, S_L, S_L0));
      }
    }
  };
  bool seen = false;
  for (int view = 0; view < num_views; ++view) {
    const Sample s = SampleOf(candidates_, basis_, options, texel, view);
    if (!(s.weight > 0.0)) continue;
    if (std::count(taken_.begin(), taken_.end(), view) > 0) {
      seen = true;
      continue;
    }
    store(light_[texel].CoefficientsWith(s.Y, s.weight, s.incoming),
          static_cast<int>(seeing.size()));
    seeing.push_back(view);
  }
  if (options_.published_mask && !seen) return;
  const int count = static_cast<int>(seeing.size());
  store(light_[texel].coefficients(), count);
  const SpectrumGrid grid{
      order,          options.num_alpha,
      options.num_ks, filter_.data(),
      factor_.data(), penalty_.empty() ? nullptr : penalty_.data()};
  std::vector<float> expected(stride);
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<float> p = Probabilities(texel, channel);
    const auto kernel = IBRDF_ACTIVE_KERNEL(ExpectedEntropy);
    kernel(grid,
           {hypothetical_.data(), scale_.data(), p.data(), stride,
            &signals[channel * order * stride], count + 1, expected.data()});
    for (int view = 0, k = 0; view < num_views; ++view) {
      const bool sees = k < count && seeing[k] == view;
      sums[view] += expected[sees ? k++ : count];
    }
  }
}

std::vector<double> BestViewSearch::ExpectedEntropies() const {
  const int num_views = candidates_.num_views, texels = candidates_.num_texels;
  const int groups = (texels + kTexelsPerSum - 1) / kTexelsPerSum;
  std::vector<double> sums(static_cast<size_t>(groups) * num_views, 0.0);
  ParallelFor(groups, num_threads_, [&](int64_t group, int) {
    const int end =
        std::min<int>(texels, static_cast<int>(group + 1) * kTexelsPerSum);
    for (int texel = static_cast<int>(group) * kTexelsPerSum; texel < end;
         ++texel) {
      AddExpected(texel, &sums[group * num_views]);
    }
  });
  std::vector<double> out(num_views, 0.0);
  for (int group = 0; group < groups; ++group) {
    for (int view = 0; view < num_views; ++view) {
      out[view] += sums[static_cast<size_t>(group) * num_views + view];
    }
  }
  for (double& x : out) x /= std::max(1, 3 * texels);
  for (const int view : taken_) {
    out[view] = std::numeric_limits<double>::infinity();
  }
  return out;
}

int BestViewSearch::Best() const {
  const std::vector<double> expected = ExpectedEntropies();
  const auto best = std::min_element(expected.begin(), expected.end());
  return std::isfinite(*best) ? static_cast<int>(best - expected.begin()) : -1;
}

std::vector<int> BestViews(const TexelSamples& candidates,
                           const std::vector<int>& initial, int count,
                           bool photographed, const BestViewOptions& options,
                           int num_threads) {
  BestViewSearch search(candidates, options, num_threads);
  for (const int view : initial) search.Add(view, photographed);
  while (static_cast<int>(search.taken().size()) < count) {
    const int best = search.Best();
    if (best < 0) break;
    search.Add(best, photographed);
  }
  return search.taken();
}

std::vector<int> FarthestPoints(const std::vector<Eigen::Vector3d>& points,
                                const std::vector<int>& initial, int count) {
  CHECK(!points.empty());
  std::vector<int> out;
  std::vector<double> distance(points.size(),
                               std::numeric_limits<double>::infinity());
  const auto take = [&](int k) {
    out.push_back(k);
    for (size_t i = 0; i < points.size(); ++i) {
      distance[i] =
          std::min(distance[i], (points[i] - points[k]).squaredNorm());
    }
    distance[k] = -1.0;
  };
  if (initial.empty() && count > 0) take(0);
  for (const int k : initial) take(k);
  const int most = std::min(count, static_cast<int>(points.size()));
  while (static_cast<int>(out.size()) < most) {
    take(static_cast<int>(std::max_element(distance.begin(), distance.end()) -
                          distance.begin()));
  }
  return out;
}

}  // namespace ibrdf
