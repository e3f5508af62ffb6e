#include "solvers/render_scene.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/light/procedural_sky.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/render/reflectance_map.h"
#include "ibrdf/render/transport.h"
#include "io/image_file.h"
#include "io/merl.h"
#include "io/mesh.h"

namespace ibrdf {
namespace {

constexpr int kReferenceSamplesPerSide = 2;
// Points between two calls of progress: well below a second at reference
// quality, enough to keep the threads busy.
constexpr size_t kPointsPerStep = 2048;
constexpr int kPreviewShadowRows = 128;
// Log radiance that interpolation between normals may cost.
constexpr double kReferenceMapError = 3e-4;
constexpr double kPreviewMapError = 3e-3;
// Whose sight decides where emitters are.
constexpr size_t kEmitterPoints = 2048;
constexpr size_t kReferenceEmitterPoints = 8192;

// A quarter of the reference's rings: within 1 % but for mirrors.
ReferenceOptions QualityOptions(RenderQuality quality, int num_threads) {
  ReferenceOptions options;
  options.num_threads = num_threads;
  if (quality == RenderQuality::kPreview) {
    options.near_rings /= 4;
    options.near_ring_samples /= 4;
    options.far_width = 64;
  }
  return options;
}

// Sets the emitters of `quality` and returns their radiance [emitters, 3]. They
// are placed and lit as in a solve, at reference quality with more of them.
std::vector<double> EmittedLight(const Scene& scene,
                                 const std::vector<ShadingPoint>& points,
                                 int bounces, bool reference, const Image& map,
                                 const BrdfGrid& grid,
                                 ReferenceOptions* quality) {
  const size_t most = reference ? kReferenceEmitterPoints : kEmitterPoints;
  const std::vector<ShadingPoint> few = SpreadPoints(points, most);
  VisibilityOptions rays;
  rays.num_threads = quality->num_threads;
  SurfaceEmitterOptions options = EmittersFor(points.size(), bounces);
  options.num_threads = quality->num_threads;
  options.max_points = static_cast<int>(most);
  if (reference) {
    options.patch = 0.05;
    options.views = 4;
    options.max_emitters = 16000;
    options.lattice_rows = 64;
  }
  TransportOptions transport;
  transport.grid = grid.shape;
  transport.num_threads = quality->num_threads;
  transport.visibility = std::make_shared<Visibility>(scene, few, rays);
  transport.emitters = std::make_shared<SurfaceEmitters>(
      scene, few, transport.visibility, options);
  quality->emitters = transport.emitters;
  return Transport({}, map.height, map.width, transport)
      .Emitted(grid, map.rgb.data());
}

// Box-Muller on bits of the generator, which the standard fixes (unlike
// std::normal_distribution): the same seed gives the same noise anywhere.
class NormalNumbers {
 public:
  explicit NormalNumbers(uint64_t seed) : rng_(seed) {}
  double Next() {
    constexpr double kTwoPi = 6.28318530717958647693;
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    return radius * std::cos(kTwoPi * Uniform());
  }

 private:
  double Uniform() {
    return std::ldexp(static_cast<double>(rng_() >> 11), -53);
  }
  std::mt19937_64 rng_;
};

}  // namespace

void AddNoise(double sigma, uint64_t seed, Image* image) {
  if (sigma <= 0.0) return;
  NormalNumbers normal(seed);
  for (float& v : image->rgb) {
    v = static_cast<float>(v * std::exp(sigma * normal.Next()));
  }
}

StatusOr<ViewPoints> FindViewPoints(const Problem& problem) {
  const StatusOr<Scene> scene = LoadScene(problem.geometry);
  if (!scene.ok()) return scene.status();
  const int width = problem.image.width, height = problem.image.height;
  StatusOr<std::vector<ShadingPoint>> found = FindShadingPoints(
      *scene, problem.camera, width, height, Mask(),
      problem.quality == RenderQuality::kReference ? kReferenceSamplesPerSide
                                                   : 1);
  if (!found.ok()) {
    return InvalidInput(problem.path, found.status().message());
  }
  ViewPoints view;
  view.scene = *scene;
  view.points = *std::move(found);
  view.mask = Mask(width, height, 0);
  for (const ShadingPoint& p : view.points) view.mask.inside[p.pixel] = 255;
  std::stable_sort(view.points.begin(), view.points.end(),
                   [](const ShadingPoint& a, const ShadingPoint& b) {
                     return a.normal.dot(a.wo) < b.normal.dot(b.wo);
                   });
  return view;
}

StatusOr<Scene> LoadScene(const GeometrySpec& geometry) {
  switch (geometry.kind) {
    case GeometryKind::kSphere:
      break;
    case GeometryKind::kMesh: {
      StatusOr<TriangleMesh> mesh = ReadMesh(geometry.file);
      if (!mesh.ok()) return mesh.status();
      if (geometry.fit == MeshFit::kUnitSphere) FitUnitSphere(&*mesh);
      StatusOr<Scene> scene = Scene::FromMesh(*mesh);
      if (!scene.ok()) {
        return InvalidInput(geometry.file, scene.status().message());
      }
      return scene;
    }
    case GeometryKind::kNormals: {
      const StatusOr<Image> normals = ReadImage(geometry.file);
      if (!normals.ok()) return normals.status();
      StatusOr<Scene> scene = Scene::FromNormalMap(*normals);
      if (!scene.ok()) {
        return InvalidInput(geometry.file, scene.status().message());
      }
      return scene;
    }
  }
  return Scene::UnitSphere();
}

StatusOr<Image> LoadKnownIllumination(const IlluminationSpec& illumination) {
  if (illumination.sky.has_value()) {
    return RenderSky(*illumination.sky, illumination.height,
                     illumination.width);
  }
  StatusOr<Image> map = ReadImage(illumination.known_file);
  if (!map.ok()) return map.status();
  for (size_t k = 0; k < map->rgb.size(); ++k) {
    if (std::isfinite(map->rgb[k]) && map->rgb[k] >= 0.0f) continue;
    const size_t pixel = k / 3;
    return InvalidInput(illumination.known_file,
                        "row " + std::to_string(pixel / map->width) +
                            ", column " + std::to_string(pixel % map->width) +
                            ": expected finite radiance >= 0, found " +
                            std::to_string(map->rgb[k]));
  }
  if (map->width % 2 != 0) {
    return InvalidInput(
        illumination.known_file,
        "width: expected an even number, found " + std::to_string(map->width));
  }
  return map;
}

StatusOr<MerlTable> LoadKnownReflectance(const ReflectanceSpec& reflectance) {
  if (reflectance.analytic.has_value()) {
    return SampleMerl(reflectance.analytic->Function());
  }
  return ReadMerl(reflectance.known_file);
}

StatusOr<RenderedScene> RenderScene(const Problem& problem,
                                    const RenderSceneOptions& options) {
  const StatusOr<ViewPoints> view = FindViewPoints(problem);
  if (!view.ok()) return view.status();
  const std::vector<ShadingPoint>& points = view->points;
  StatusOr<Image> map = LoadKnownIllumination(problem.illumination);
  if (!map.ok()) return map.status();

  MerlTable table;
  if (!problem.reflectance.known_file.empty()) {
    StatusOr<MerlTable> read = ReadMerl(problem.reflectance.known_file);
    if (!read.ok()) return read.status();
    table = *std::move(read);
  }

  BrdfGrid grid;
  if (view->scene.CastsShadows()) {
    const auto& analytic = problem.reflectance.analytic;
    grid = analytic.has_value()
               ? BrdfGrid::FromFunction(analytic->Function(), {})
               : BrdfGrid::FromMerl(table, {});
  }
  const bool reference = problem.quality == RenderQuality::kReference;
  StatusOr<EffectsPlan> effects =
      PlanEffects(problem, view->scene, points, &*map, &grid,
                  reference ? kReferenceLogError : kWorthwhileLogError,
                  options.num_threads);
  if (!effects.ok()) return effects.status();
  ReferenceOptions quality =
      QualityOptions(problem.quality, options.num_threads);
  if (effects->visibility) {
    quality.shadows = std::make_shared<VisibilityGrid>(
        view->scene, reference ? kReferenceShadowRows : kPreviewShadowRows);
  }
  std::vector<double> emitted;
  if (effects->bounces > 0) {
    emitted = EmittedLight(view->scene, points, effects->bounces, reference,
                           *map, grid, &quality);
  }
  const double* const emitted_light =
      emitted.empty() ? nullptr : emitted.data();
  const ReferenceRenderer renderer(*map, quality);
  const auto render = [&](const std::vector<ShadingPoint>& some, double* E) {
    if (problem.reflectance.analytic.has_value()) {
      renderer.Render(some, problem.reflectance.analytic->Function(), E,
                      emitted_light);
    } else {
      renderer.Render(some, table, E, emitted_light);
    }
  };
  std::vector<double> E(3 * points.size());
  const auto in_steps = [&](const std::vector<ShadingPoint>& all, double* out) {
    for (size_t begin = 0; begin < all.size(); begin += kPointsPerStep) {
      if (options.progress &&
          !options.progress(static_cast<double>(begin) / points.size())) {
        return false;
      }
      const size_t end = std::min(begin + kPointsPerStep, all.size());
      render({all.begin() + begin, all.begin() + end}, out + 3 * begin);
    }
    return true;
  };
  if (effects->reflectance_map) {
    ReflectanceMapOptions by_normal;
    by_normal.log_error = reference ? kReferenceMapError : kPreviewMapError;
    const StatusOr<ReflectanceMapReport> report =
        RenderByNormal(points, in_steps, by_normal, E.data());
    if (!report.ok()) {
      return report.status().code() == StatusCode::kInterrupted
                 ? Status(StatusCode::kInterrupted,
                          problem.path + ": interrupted")
                 : report.status();
    }
    effects->words += "; " + std::to_string(report->interpolated) + " of " +
                      std::to_string(points.size()) +
                      " points are interpolated by their normal from others";
  } else if (!in_steps(points, E.data())) {
    return Status(StatusCode::kInterrupted, problem.path + ": interrupted");
  }
  if (options.progress) options.progress(1.0);

  RenderedScene out;
  out.image =
      PixelMeans(points, E.data(), problem.image.width, problem.image.height);
  out.mask = view->mask;
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
