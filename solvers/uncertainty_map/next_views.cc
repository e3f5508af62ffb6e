#include "ibrdf/solvers/uncertainty_map/next_views.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "ibrdf/geometry/camera.h"
#include "ibrdf/solvers/next_view/candidate_views.h"
#include "ibrdf/solvers/uncertainty_map/texel_entropy.h"
#include "ibrdf/uncertainty/best_view.h"

namespace ibrdf {
namespace {

// The search costs as many fits for each candidate.
constexpr int64_t kMostTexels = 1000;
// The place in the picture alone matters of what candidates see, not pixels.
constexpr int kShortSide = 16;

// Numbers of texels at equal steps of area: a texel's share of them is that of
// its area, so that the poles of a sphere, with many small texels, weigh no
// more than the rest.
std::vector<int64_t> SpreadTexels(const std::vector<SurfaceTexel>& texels) {
  const auto count = static_cast<int64_t>(texels.size());
  const int64_t kept = std::min(count, kMostTexels);
  double area = 0.0;
  for (const SurfaceTexel& texel : texels) area += texel.area;
  std::vector<int64_t> out;
  double passed = texels[0].area;
  for (int64_t i = 0, at = 0; i < kept; ++i) {
    const double step =
        area * (static_cast<double>(i) + 0.5) / static_cast<double>(kept);
    while (passed < step && at + 1 < count) passed += texels[++at].area;
    out.push_back(at);
  }
  return out;
}

// Copies views [0, from.num_views) of a texel to those after `first`.
void CopyViews(const TexelObservations& from, int from_texel, int to_texel,
               int first, TexelObservations* to) {
  const size_t source = static_cast<size_t>(from_texel) * from.num_views;
  const size_t target = static_cast<size_t>(to_texel) * to->num_views + first;
  const size_t count = from.num_views;
  const auto copy = [&](const auto& a, size_t width, auto* b) {
    std::copy_n(a.begin() + source * width, count * width,
                b->begin() + target * width);
  };
  copy(from.directions, 3, &to->directions);
  copy(from.outgoing, 3, &to->outgoing);
  copy(from.incoming, 3, &to->incoming);
  copy(from.weight, 1, &to->weight);
}

// The candidates as views; their images are never read.
struct CandidateViews {
  std::vector<ObservedView> views;
  std::vector<SizedCamera> cameras;
};

StatusOr<CandidateViews> ViewsOf(const std::vector<CalibratedView>& candidates,
                                 double aspect) {
  CandidateViews out;
  for (const CalibratedView& candidate : candidates) {
    const StatusOr<SizedCamera> camera =
        CandidateCamera(candidate, aspect, kShortSide);
    if (!camera.ok()) return camera.status();
    ObservedView view;
    view.camera = camera->camera;
    view.radiance = Image(camera->width, camera->height);
    out.views.push_back(std::move(view));
    out.cameras.push_back(*camera);
  }
  return out;
}

// 1 where a ray reaches the candidate and the texel is in its picture.
void SetSeen(const SurfaceAtlas& atlas, const std::vector<SizedCamera>& cameras,
             TexelObservations* observations) {
  for (int i = 0; i < observations->num_texels; ++i) {
    for (int k = 0; k < observations->num_views; ++k) {
      const size_t at = static_cast<size_t>(i) * observations->num_views + k;
      const SizedCamera& c = cameras[k];
      const std::optional<ImagePoint> p =
          ProjectPoint(c.camera, atlas.texels[i].position, c.width, c.height);
      const bool inside = p && p->x >= 0.0 && p->x <= c.width && p->y >= 0.0 &&
                          p->y <= c.height;
      observations->weight[at] =
          inside && observations->visible[at] != 0 ? 1.0f : 0.0f;
    }
  }
}

// Photographs first, then candidates.
StatusOr<TexelSamples> AllViews(const UncertaintyInputs& inputs,
                                const TexelObserver& observer,
                                const UncertaintySpec& spec,
                                const std::vector<CalibratedView>& candidates,
                                int num_threads) {
  const Image& first = inputs.views[0].radiance;
  StatusOr<CandidateViews> views =
      ViewsOf(candidates, static_cast<double>(first.width) / first.height);
  if (!views.ok()) return views.status();
  const std::vector<int64_t> kept = SpreadTexels(inputs.surface.atlas.texels);
  SurfaceAtlas atlas;
  atlas.width = inputs.surface.atlas.width;
  atlas.height = inputs.surface.atlas.height;
  for (const int64_t i : kept) {
    atlas.texels.push_back(inputs.surface.atlas.texels[i]);
  }
  ObserverOptions options;
  options.shadowed_light = spec.shadows == EntropyShadows::kMirror;
  options.num_threads = num_threads;
  const StatusOr<TexelObserver> hypothetical =
      TexelObserver::Make(inputs.surface.scene, atlas, std::move(views->views),
                          inputs.prefiltered, options);
  if (!hypothetical.ok()) return hypothetical.status();
  TexelObservations seen =
      hypothetical->Observe(0, static_cast<int64_t>(kept.size()));
  SetSeen(atlas, views->cameras, &seen);

  TexelObservations all;
  all.num_texels = static_cast<int>(kept.size());
  all.num_views = observer.num_views() + seen.num_views;
  const size_t samples = static_cast<size_t>(all.num_texels) * all.num_views;
  for (std::vector<float>* values :
       {&all.directions, &all.outgoing, &all.incoming}) {
    values->assign(3 * samples, 0.0f);
  }
  all.weight.assign(samples, 0.0f);
  for (int i = 0; i < all.num_texels; ++i) {
    CopyViews(observer.Observe(kept[i], kept[i] + 1), 0, i, 0, &all);
    CopyViews(seen, i, i, observer.num_views(), &all);
  }
  return SamplesOf(std::move(all),
                   {inputs.mean_radiance, inputs.prefilter_alpha, nullptr});
}

std::vector<int> FarthestFrom(const UncertaintyInputs& inputs,
                              const std::vector<CalibratedView>& candidates,
                              int count) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const SurfaceTexel& texel : inputs.surface.atlas.texels) {
    middle += texel.position;
  }
  middle /= static_cast<double>(inputs.surface.atlas.texels.size());
  return FarthestCandidates(candidates, SettingOf(inputs).photographs, middle,
                            count);
}

BestViewOptions SearchOptionsOf(const UncertaintySpec& spec) {
  BestViewOptions options;
  const double sigma = options.spectrum.sigma;
  options.spectrum = SpectrumOptionsOf(spec);
  const bool stated =
      spec.evaluator == EntropyModel::kSpectrum && spec.sigma.has_value();
  if (!stated) options.spectrum.sigma = sigma;
  return options;
}

// Mean over texels and channels with the photographs alone.
double EntropyBefore(const TexelSamples& samples,
                     const BestViewOptions& options, int num_photographed,
                     int num_threads) {
  TexelSamples photographed = samples;
  for (int i = 0; i < samples.num_texels; ++i) {
    const auto row = photographed.weight.begin() +
                     static_cast<int64_t>(i) * samples.num_views;
    std::fill(row + num_photographed, row + samples.num_views, 0.0f);
  }
  const StatusOr<EntropyMaps> maps = SpectrumEntropyEvaluator(options.spectrum)
                                         .Evaluate(photographed, num_threads);
  if (!maps.ok()) return 1.0;
  double sum = 0.0;
  for (const float h : maps->entropy) sum += h;
  return sum / static_cast<double>(maps->entropy.size());
}

}  // namespace

StatusOr<NextViews> ChooseNextViews(const UncertaintyInputs& inputs,
                                    const TexelObserver& observer,
                                    const UncertaintySpec& spec,
                                    std::vector<CalibratedView> candidates,
                                    const NextViewOptions& options) {
  const StatusOr<TexelSamples> samples =
      AllViews(inputs, observer, spec, candidates, options.num_threads);
  if (!samples.ok()) return samples.status();
  const int num_photographed = observer.num_views();
  const int count =
      std::min(options.count, static_cast<int>(candidates.size()));
  const BestViewOptions search_options = SearchOptionsOf(spec);
  BestViewSearch search(*samples, search_options, options.num_threads);
  NextViews out;
  out.texels = samples->num_texels;
  for (int k = 0; k < num_photographed; ++k) search.Add(k, true);
  out.expected_entropy.push_back(EntropyBefore(
      *samples, search_options, num_photographed, options.num_threads));
  for (int i = 0; i < count; ++i) {
    const std::vector<double> expected = search.ExpectedEntropies();
    const auto best = std::min_element(expected.begin(), expected.end());
    const int view = static_cast<int>(best - expected.begin());
    out.expected_entropy.push_back(*best);
    out.chosen.push_back(view - num_photographed);
    search.Add(view, false);
  }
  out.farthest = FarthestFrom(inputs, candidates, count);
  out.candidates = std::move(candidates);
  return out;
}

}  // namespace ibrdf
