#include "ibrdf/solvers/forward/render_scene.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "ibrdf/approximation/reflectance_map.h"
#include "ibrdf/base/normal_source.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/scene/pixel_samples.h"
#include "ibrdf/solvers/forward/approximate_radiance.h"
#include "ibrdf/solvers/forward/measured_effects.h"
#include "ibrdf/solvers/forward/scene_radiance.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/transport/lobe_bundles.h"

namespace ibrdf {
namespace {

// Of pixels at reference quality and, in a preview, of those that call for it.
constexpr int kSamplesPerSide = 2;
// Log radiance that interpolation between normals, and taking the centre of a
// pixel for all of it, may cost.
constexpr double kReferenceMapError = 3e-4;
constexpr double kPreviewMapError = 3e-3;
constexpr double kPreviewPixelError = 3e-3;
// Of twice the rays of narrow lobes: about what the image is off by.
constexpr double kPreviewLobeError = 0.015;

Status Interrupted(const Problem& problem) {
  return Status(StatusCode::kInterrupted, problem.path + ": interrupted");
}

double MapError(RenderQuality quality) {
  return quality == RenderQuality::kReference ? kReferenceMapError
                                              : kPreviewMapError;
}

// Those of one view angle share work.
void SortByAngle(std::vector<ShadingPoint>* points) {
  std::stable_sort(points->begin(), points->end(),
                   [](const ShadingPoint& a, const ShadingPoint& b) {
                     return a.normal.dot(a.wo) < b.normal.dot(b.wo);
                   });
}

// How the points of a scene are rendered that nothing shadows. A preview takes
// what is fast; reference quality only what the user asks for.
ApproximationOptions MayTake(const Problem& problem,
                             const EffectsPlan& effects) {
  ApproximationOptions options;
  options.log_error = MapError(problem.quality);
  if (effects.visibility) return options;
  options.reflectance_map = effects.reflectance_map;
  const EffectsSpec& spec = problem.effects;
  if (spec.mode == EffectsMode::kAuto) {
    options.harmonics = options.gaussians =
        problem.quality == RenderQuality::kPreview;
  } else if (spec.mode == EffectsMode::kList) {
    options.harmonics = spec.Lists(Effect::kHarmonics);
    options.gaussians = spec.Lists(Effect::kGaussians);
    options.forced = options.harmonics || options.gaussians;
  }
  return options;
}

// Pixels of one scene, in one or two passes.
class PixelRenderer {
 public:
  PixelRenderer(const Problem& problem, const SceneRadiance& radiance,
                ApproximateRadiance* approximation,
                const RenderSceneOptions& options)
      : problem_(problem),
        radiance_(radiance),
        approximation_(approximation),
        options_(options) {}

  // Calls progress with shares of [begin, end].
  StatusOr<Image> Render(const std::vector<ShadingPoint>& points, double begin,
                         double end) {
    std::vector<double> L_o(3 * points.size());
    const auto all = [&](const std::vector<ShadingPoint>& some, double* out) {
      const auto progress = [&](double share) {
        return options_.progress(begin + (end - begin) * share);
      };
      return radiance_.Render(
          some, options_.progress ? progress : std::function<bool(double)>(),
          out);
    };
    num_points_ += points.size();
    const Status interrupted = Interrupted(problem_);
    if (approximation_->renders()) {
      if (options_.progress && !options_.progress(begin)) return interrupted;
      approximation_->Render(points, L_o.data());
    } else if (approximation_->plan().approximation ==
               Approximation::kReflectanceMap) {
      ReflectanceMapOptions by_normal;
      by_normal.log_error = MapError(problem_.quality);
      const StatusOr<ReflectanceMapReport> report =
          RenderByNormal(points, all, by_normal, L_o.data());
      if (!report.ok()) {
        return report.status().code() == StatusCode::kInterrupted
                   ? interrupted
                   : report.status();
      }
      num_interpolated_ += report->interpolated;
    } else if (!all(points, L_o.data())) {
      return interrupted;
    }
    return PixelMeans(points, L_o.data(), problem_.image.width,
                      problem_.image.height);
  }

  // Renders the pixels anew whose centre does not stand for them within
  // log_error.
  Status Refine(const Scene& scene, const Mask& mask, double log_error,
                double begin, double end, Image* image) {
    const Mask unclear = PixelsToSample(*image, mask, log_error);
    if (unclear.empty()) return Status();
    StatusOr<std::vector<ShadingPoint>> points =
        FindShadingPoints(scene, problem_.camera, image->width, image->height,
                          unclear, kSamplesPerSide, options_.num_threads);
    if (!points.ok()) return points.status();
    SortByAngle(&*points);
    const StatusOr<Image> finer = Render(*points, begin, end);
    if (!finer.ok()) return finer.status();
    // All samples of a pixel may pass by what its centre meets.
    std::vector<char> met(image->num_pixels(), 0);
    for (const ShadingPoint& p : *points) met[p.pixel] = 1;
    for (size_t k = 0; k < image->rgb.size(); ++k) {
      if (met[k / 3] != 0) image->rgb[k] = finer->rgb[k];
    }
    num_refined_ = unclear.CountInside();
    return Status();
  }

  // For the user, after the plan's.
  std::string words() const {
    std::string text;
    if (num_refined_ > 0) {
      text += "; " + std::to_string(num_refined_) + " pixels are sampled " +
              std::to_string(kSamplesPerSide * kSamplesPerSide) + " times";
    }
    if (approximation_->plan().approximation ==
        Approximation::kReflectanceMap) {
      text += "; " + std::to_string(num_interpolated_) + " of " +
              std::to_string(num_points_) +
              " points are interpolated by their normal from others";
    }
    return text;
  }

 private:
  const Problem& problem_;
  const SceneRadiance& radiance_;
  ApproximateRadiance* const approximation_;
  const RenderSceneOptions& options_;
  size_t num_points_ = 0, num_interpolated_ = 0, num_refined_ = 0;
};

}  // namespace

void AddNoise(double sigma, uint64_t seed, Image* image) {
  if (sigma <= 0.0) return;
  DoubleNormalSource normal(seed);
  for (float& v : image->rgb) {
    v = static_cast<float>(v * std::exp(sigma * normal.Next()));
  }
}

StatusOr<ViewPoints> FindViewPoints(const Problem& problem, int num_threads) {
  const StatusOr<Scene> scene = LoadScene(problem.geometry);
  if (!scene.ok()) return scene.status();
  const int width = problem.image.width, height = problem.image.height;
  StatusOr<std::vector<ShadingPoint>> found = FindShadingPoints(
      *scene, problem.camera, width, height, Mask(),
      problem.quality == RenderQuality::kReference ? kSamplesPerSide : 1,
      num_threads);
  if (!found.ok()) {
    return InvalidInput(problem.path, found.status().message());
  }
  ViewPoints view;
  view.scene = *scene;
  view.points = *std::move(found);
  view.mask = Mask(width, height, 0);
  for (const ShadingPoint& p : view.points) view.mask.inside[p.pixel] = 255;
  SortByAngle(&view.points);
  return view;
}

StatusOr<RenderedScene> RenderScene(const Problem& problem,
                                    const RenderSceneOptions& options) {
  const StatusOr<ViewPoints> view =
      FindViewPoints(problem, options.num_threads);
  if (!view.ok()) return view.status();
  const std::vector<ShadingPoint>& points = view->points;
  StatusOr<Image> map = LoadKnownIllumination(problem.illumination);
  if (!map.ok()) return map.status();

  KnownBrdf brdf;
  if (problem.reflectance.analytic.has_value()) {
    brdf.function = problem.reflectance.analytic->Function();
  } else {
    StatusOr<MerlTable> read = ReadMerl(problem.reflectance.known_file);
    if (!read.ok()) return read.status();
    brdf.table = *std::move(read);
  }
  BrdfGrid grid;
  if (view->scene.CastsShadows()) grid = brdf.Grid();
  const bool reference = problem.quality == RenderQuality::kReference;
  // A preview of a mirror-like object looks along the lobe's own rays.
  const bool narrow_lobe =
      view->scene.CastsShadows() && LobeHalfWidth(brdf.Lookup()) < kNarrowLobe;
  std::unique_ptr<SceneRadiance> radiance;
  EffectsMeasure measure;
  if (!reference && narrow_lobe) {
    measure = [&] {
      EffectsPlan none, all;
      all.visibility = true;
      all.bounces = kMostBounces;
      const SceneRadiance bare(view->scene, points, *map, &brdf, grid, none,
                               problem.quality, options.num_threads);
      radiance = std::make_unique<SceneRadiance>(
          view->scene, points, *map, &brdf, grid, all, problem.quality,
          options.num_threads);
      const OmissionErrors omission =
          MeasureEffects(bare, points, radiance.get());
      ChooseLobeRays(points, kPreviewLobeError, radiance.get());
      return omission;
    };
  }
  StatusOr<EffectsPlan> effects =
      PlanEffects(problem, view->scene, points, &*map, &grid,
                  reference ? kReferenceOmissionError : kPreviewOmissionError,
                  options.num_threads, measure);
  if (!effects.ok()) return effects.status();
  if (radiance == nullptr || !effects->visibility) {
    radiance = std::make_unique<SceneRadiance>(view->scene, points, *map, &brdf,
                                               grid, *effects, problem.quality,
                                               options.num_threads);
  } else {
    radiance->set_bounces(effects->bounces);
  }
  if (narrow_lobe && effects->bounces > 0) {
    effects->words += "; " + std::to_string(radiance->lobe_rays()) +
                      " rays of its own for each narrow lobe";
  }
  ApproximateRadiance approximation(*map, brdf, options.num_threads);
  const auto quadrature = [&](const std::vector<ShadingPoint>& some,
                              double* L_o) {
    return radiance->Render(some, nullptr, L_o);
  };
  // At reference quality, as a preview is off by more than what is looked for
  // under a small sun.
  const auto converged = [&](const std::vector<ShadingPoint>& some,
                             double* L_o) {
    return SceneRadiance(view->scene, some, *map, &brdf, grid, *effects,
                         RenderQuality::kReference, options.num_threads)
        .Render(some, nullptr, L_o);
  };
  if (!approximation.Choose(points, quadrature, converged,
                            MayTake(problem, *effects))) {
    return Interrupted(problem);
  }
  effects->approximation = approximation.plan();
  effects->reflectance_map =
      approximation.plan().approximation == Approximation::kReflectanceMap;
  effects->words += approximation.plan().words;
  RenderedScene out;
  if (options.plan_only) {
    out.effects = *std::move(effects);
    return out;
  }
  PixelRenderer pixels(problem, *radiance, &approximation, options);
  // The second pass is of fewer pixels but more points.
  const double first = reference ? 1.0 : 0.5;
  StatusOr<Image> image = pixels.Render(points, 0.0, first);
  if (!image.ok()) return image.status();
  out.image = *std::move(image);
  out.mask = view->mask;
  if (!reference) {
    // What a mirror shows of its own object has detail that the differences
    // between pixels do not tell of.
    const double log_error =
        narrow_lobe && effects->bounces > 0 ? 0.0 : kPreviewPixelError;
    IBRDF_RETURN_IF_ERROR(pixels.Refine(view->scene, out.mask, log_error, first,
                                        1.0, &out.image));
  }
  if (options.progress) options.progress(1.0);
  effects->words += pixels.words();
  out.effects = *std::move(effects);
  out.illumination = *std::move(map);
  AddNoise(problem.noise,
           problem.solver.seed.has_value()
               ? static_cast<uint64_t>(*problem.solver.seed)
               : options.seed,
           &out.image);
  return out;
}

}  // namespace ibrdf
