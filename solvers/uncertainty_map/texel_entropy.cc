#include "ibrdf/solvers/uncertainty_map/texel_entropy.h"

#include <algorithm>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/uncertainty/angular_entropy.h"
#include "ibrdf/uncertainty/band_limit.h"
#include "ibrdf/uncertainty/measured_materials.h"
#include "ibrdf/uncertainty/reflection_filter.h"

namespace ibrdf {
namespace {

// 44 bytes each, in all.
constexpr int64_t kSamplesPerBlock = int64_t{1} << 20;
// Whole batches of the fit.
constexpr int64_t kTexelsPerBlock = 256;

void Append(const EntropyMaps& block, EntropyMaps* all) {
  all->num_texels += block.num_texels;
  const auto append = [](const std::vector<float>& from,
                         std::vector<float>* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  append(block.entropy, &all->entropy);
  append(block.alpha, &all->alpha);
  append(block.Ks, &all->Ks);
  append(block.Kd, &all->Kd);
  append(block.misfit, &all->misfit);
  append(block.deviations, &all->deviations);
}

// Fills in the irradiance of texels from `begin` on.
void FillIrradiance(const TexelObserver& observer, const LightScale& light,
                    int64_t begin, int num_threads, TexelSamples* samples) {
  if (light.irradiance == nullptr) return;
  samples->irradiance.resize(3 * static_cast<size_t>(samples->num_texels));
  ParallelFor(samples->num_texels, num_threads, [&](int64_t i, int) {
    const SurfaceTexel& texel = observer.atlas().texels[begin + i];
    const Eigen::Array3d E = light.irradiance->At(observer.RayStart(texel),
                                                  texel.normal.cast<double>());
    for (int c = 0; c < 3; ++c) {
      samples->irradiance[3 * i + c] = static_cast<float>(E[c]);
    }
  });
}

// Empty: uniform.
std::vector<double> PriorOf(const UncertaintySpec& spec, AlphaGrid grid,
                            int num_alpha, int num_ks) {
  if (spec.prior == EntropyPrior::kUniform) return {};
  return PriorOfMeasuredMaterials(AlphaValues(grid, num_alpha),
                                  UnitValues(num_ks));
}

void CountViews(const TexelSamples& samples, TexelEntropy* out) {
  for (int i = 0; i < samples.num_texels; ++i) {
    int seen = 0;
    for (int k = 0; k < samples.num_views; ++k) {
      const size_t at = static_cast<size_t>(i) * samples.num_views + k;
      if (!(samples.weight[at] > 0.0f)) continue;
      ++seen;
      ++out->texels_of_view[k];
    }
    out->observed_views.push_back(seen);
  }
}

}  // namespace

int TexelEntropy::CountObserved() const {
  return static_cast<int>(std::count_if(observed_views.begin(),
                                        observed_views.end(),
                                        [](int views) { return views > 0; }));
}

double TexelEntropy::MeanEntropy(bool observed_alone) const {
  double sum = 0.0;
  int64_t count = 0;
  for (size_t i = 0; i < observed_views.size(); ++i) {
    if (observed_alone && observed_views[i] == 0) continue;
    for (int c = 0; c < 3; ++c) sum += maps.entropy[3 * i + c];
    count += 3;
  }
  return count > 0 ? sum / static_cast<double>(count) : 1.0;
}

TexelSamples SamplesOf(TexelObservations observations,
                       const LightScale& light) {
  TexelSamples samples;
  samples.num_texels = observations.num_texels;
  samples.num_views = observations.num_views;
  samples.directions = std::move(observations.directions);
  samples.outgoing = std::move(observations.outgoing);
  samples.incoming = std::move(observations.incoming);
  samples.weight = std::move(observations.weight);
  samples.mean_radiance = light.mean_radiance;
  samples.prefilter_alpha = light.prefilter_alpha;
  return samples;
}

SpectrumOptions SpectrumOptionsOf(const UncertaintySpec& spec) {
  SpectrumOptions options;
  options.fit.order = spec.order;
  options.prior =
      PriorOf(spec, options.alpha_grid, options.num_alpha, options.num_ks);
  // The angular evaluator's is another quantity.
  if (spec.evaluator == EntropyModel::kSpectrum && spec.sigma.has_value()) {
    options.sigma = *spec.sigma;
  }
  return options;
}

std::unique_ptr<EntropyEvaluator> MakeEvaluator(const UncertaintySpec& spec) {
  if (spec.evaluator == EntropyModel::kSpectrum) {
    return std::make_unique<SpectrumEntropyEvaluator>(SpectrumOptionsOf(spec));
  }
  AngularOptions options;
  options.fit.order = spec.order;
  options.prior =
      PriorOf(spec, options.alpha_grid, options.num_alpha, options.num_ks);
  if (spec.sigma.has_value()) options.sigma = *spec.sigma;
  return std::make_unique<AngularEntropyEvaluator>(options);
}

StatusOr<TexelEntropy> EvaluateTexels(const TexelObserver& observer,
                                      const LightScale& light,
                                      const UncertaintySpec& spec,
                                      int num_threads,
                                      const TexelProgress& progress) {
  const std::unique_ptr<EntropyEvaluator> evaluator = MakeEvaluator(spec);
  const auto count = static_cast<int64_t>(observer.atlas().texels.size());
  const int64_t block =
      std::max(kTexelsPerBlock, kSamplesPerBlock / observer.num_views() /
                                    kTexelsPerBlock * kTexelsPerBlock);
  TexelEntropy out;
  out.texels_of_view.assign(observer.num_views(), 0);
  for (int64_t begin = 0; begin < count; begin += block) {
    if (progress &&
        !progress(static_cast<double>(begin) / static_cast<double>(count))) {
      return Status(StatusCode::kInterrupted, "interrupted");
    }
    TexelSamples samples = SamplesOf(
        observer.Observe(begin, std::min(begin + block, count)), light);
    if (spec.evaluator == EntropyModel::kAngular) {
      FillIrradiance(observer, light, begin, num_threads, &samples);
    }
    const StatusOr<EntropyMaps> maps =
        evaluator->Evaluate(samples, num_threads);
    if (!maps.ok()) return maps.status();
    Append(*maps, &out.maps);
    CountViews(samples, &out);
  }
  if (progress) progress(1.0);
  out.below_band_limit = BelowBandLimit(out.maps);
  return out;
}

}  // namespace ibrdf
