#include "ibrdf/solvers/problem/load_problem.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/problem/load_photograph.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/solvers/problem/open_model.h"
#include "ibrdf/solvers/problem/quadrature_level.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {
namespace {

constexpr int kLeastKnownWidth = 128;
// Beyond it texels are finer than pixels and rings (PointQuadrature) show them.
constexpr int kMostKnownWidth = 256;
// Blocks of texels that a transport takes of a map; the rest of its sources are
// patches and bright samples.
constexpr int kMostFarCells = 3 * kMaxFarSources / 4;

// Below this share of the mask's pixels that see the object there is nothing to
// estimate from; below this overlap (intersection over union) of mask and
// object it is worth a word. The same silhouette drawn by two programs overlaps
// by 0.95 and more.
constexpr double kLeastCovered = 0.05;
constexpr double kUsualOverlap = 0.92;

struct ObjectPoints {
  Scene scene = Scene::UnitSphere();
  std::vector<ShadingPoint> points;  // at pixels' centres
};

// Follows "geometry".
std::string FitAdvice(const Problem& problem) {
  const bool moved = problem.geometry.kind == GeometryKind::kMesh &&
                     problem.geometry.fit == MeshFit::kUnitSphere;
  return moved ? ".fit: unit_sphere moved and scaled the mesh, not the camera"
               : "";
}

// Holds the object's silhouette against the mask, of whose pixels `covered` see
// the object.
Status CheckSilhouette(const Problem& problem, const Photograph& observed,
                       const Scene& scene, size_t covered, int num_threads,
                       std::vector<std::string>* warnings) {
  if (problem.image.mask.empty()) return OkStatus();
  Mask beside = observed.mask;
  for (uint8_t& inside : beside.inside) inside = inside == 0 ? 1 : 0;
  const size_t of_mask = beside.inside.size() -
                         static_cast<size_t>(std::count(
                             beside.inside.begin(), beside.inside.end(), 1));
  // Fails where there are none: the sizes fitted before.
  const StatusOr<std::vector<ShadingPoint>> outside =
      FindShadingPoints(scene, problem.camera, observed.radiance.width,
                        observed.radiance.height, beside, 1, num_threads);
  const auto both = static_cast<double>(covered);
  const double overlap =
      both /
      static_cast<double>(of_mask + (outside.ok() ? outside->size() : 0));
  if (overlap >= kUsualOverlap) return OkStatus();
  const std::string text =
      "the object covers " + std::to_string(covered) + " of the mask's " +
      std::to_string(of_mask) + " pixels (overlap " + Format("%.2f", overlap) +
      "): check the camera, its field of view and up axis, and geometry" +
      FitAdvice(problem);
  if (both < kLeastCovered * static_cast<double>(of_mask)) {
    return InvalidInput(problem.image.mask, text);
  }
  warnings->push_back(problem.image.mask + ": " + text);
  return OkStatus();
}

StatusOr<ObjectPoints> FindObjectPoints(const Problem& problem,
                                        const Photograph& observed,
                                        int num_threads,
                                        std::vector<std::string>* warnings) {
  const StatusOr<Scene> scene = LoadScene(problem.geometry, warnings);
  if (!scene.ok()) return scene.status();
  StatusOr<std::vector<ShadingPoint>> points = FindShadingPoints(
      *scene, problem.camera, observed.radiance.width, observed.radiance.height,
      observed.mask, 1, num_threads);
  if (!points.ok()) {
    return InvalidInput(problem.path, points.status().message() +
                                          "; check the camera and geometry" +
                                          FitAdvice(problem));
  }
  IBRDF_RETURN_IF_ERROR(CheckSilhouette(problem, observed, *scene,
                                        points->size(), num_threads, warnings));
  return ObjectPoints{*scene, *std::move(points)};
}

// Sets the model, or the grid of a known reflectance.
Status LoadReflectance(const ReflectanceSpec& reflectance,
                       InverseProblem* inverse) {
  if (reflectance.known()) {
    const StatusOr<MerlTable> table = LoadKnownReflectance(reflectance);
    if (!table.ok()) return table.status();
    inverse->known_brdf = BrdfGrid::FromMerl(*table, inverse->transport.grid);
    return OkStatus();
  }
  StatusOr<OpenedModel> opened =
      OpenModel(reflectance.model.empty() ? "default" : reflectance.model);
  if (!opened.ok()) return opened.status();
  inverse->model =
      std::make_shared<const NeuralBrdfModel>(std::move(opened->model));
  return OkStatus();
}

// Sides that do not halve leave a map of many texels in as many cells.
Status CheckMapSize(const Problem& problem, int far_width) {
  const int width = problem.illumination.width;
  const int height = problem.illumination.height;
  const int cells = NumFarCells(height, width, far_width);
  if (cells <= kMostFarCells) return OkStatus();
  return InvalidInput(problem.path + ": illumination.width",
                      "expected a map whose width and height can both be "
                      "halved until at most " +
                          std::to_string(kMostFarCells) +
                          " texels are left, as powers of two can, found " +
                          SizeName(width, height));
}

// The width of a known map that no size is asked for: its own, to a power of
// two.
int KnownMapWidth(int width) {
  int out = kLeastKnownWidth;
  while (out < kMostKnownWidth && 2 * out <= width) out *= 2;
  return out;
}

// Sets the known map, and the size that it is taken at.
Status LoadIllumination(const Problem& problem, InverseProblem* inverse) {
  const IlluminationSpec& illumination = problem.illumination;
  if (!illumination.known()) return OkStatus();
  const StatusOr<Image> map =
      LoadKnownIllumination(illumination, &inverse->warnings);
  if (!map.ok()) return map.status();
  if (std::none_of(map->rgb.begin(), map->rgb.end(),
                   [](float v) { return v > 0.0f; })) {
    return InvalidInput(problem.path + ": illumination.known",
                        "expected light from somewhere, found a black map");
  }
  if (!illumination.sized && !illumination.known_file.empty()) {
    inverse->map_width = KnownMapWidth(map->width);
    inverse->map_height = inverse->map_width / 2;
  }
  inverse->known_map =
      map->width == inverse->map_width && map->height == inverse->map_height
          ? *map
          : ResizeMap(*map, inverse->map_height, inverse->map_width);
  return OkStatus();
}

// Rays from the points that find what the object hides of the light, and
// patches by which it lights itself.
void TraceEffects(const Scene& scene, InverseProblem* inverse) {
  VisibilityOptions rays;
  rays.num_threads = inverse->num_threads;
  TransportOptions* transport = &inverse->transport;
  transport->visibility =
      std::make_shared<Visibility>(scene, inverse->points, rays);
  if (inverse->effects.bounces == 0) return;
  RadiosityOptions patches =
      PatchesFor(inverse->points.size(), inverse->effects.bounces);
  patches.num_threads = inverse->num_threads;
  transport->patches = std::make_shared<RadiosityPatches>(
      scene, inverse->points, transport->visibility, patches);
}

// Sets the effects and what the transport needs for them.
Status PlanAndTraceEffects(const Problem& problem, const Scene& scene,
                           InverseProblem* inverse) {
  std::optional<Image>* map = &inverse->known_map;
  EffectsOptions options;
  options.threshold = kSolveOmissionError;
  options.known_map = map->has_value() ? &**map : nullptr;
  options.known_brdf =
      inverse->known_brdf.has_value() ? &*inverse->known_brdf : nullptr;
  options.num_threads = inverse->num_threads;
  StatusOr<EffectsPlan> effects =
      PlanEffects(problem, scene, inverse->points, options);
  if (!effects.ok()) return effects.status();
  inverse->effects = *std::move(effects);
  if (!inverse->effects.visibility) return OkStatus();
  // A block of texels that is hidden in part is taken texel by texel.
  if (map->has_value() && !problem.illumination.sized &&
      inverse->map_width > kLeastKnownWidth) {
    inverse->map_width = kLeastKnownWidth;
    inverse->map_height = kLeastKnownWidth / 2;
    *map = ResizeMap(**map, inverse->map_height, inverse->map_width);
  }
  TraceEffects(scene, inverse);
  return OkStatus();
}

// What the file says without naming another.
InverseProblem SettingsOf(const Problem& problem, uint64_t default_seed,
                          int num_threads) {
  InverseProblem inverse;
  inverse.kind = problem.kind;
  inverse.lobes = problem.reflectance.lobes;
  inverse.prior_sigma = problem.reflectance.prior_sigma;
  inverse.map_width = problem.illumination.width;
  inverse.map_height = problem.illumination.height;
  inverse.illumination_prior = problem.illumination.prior;
  inverse.unet_channels = problem.illumination.unet_channels;
  inverse.scale = problem.likelihood.scale;
  inverse.epsilon = problem.likelihood.epsilon;
  inverse.solver = problem.solver;
  inverse.transport.quadrature =
      AtLevel(inverse.transport.quadrature, problem.solver.quadrature);
  inverse.seed = problem.solver.seed.has_value()
                     ? static_cast<uint64_t>(*problem.solver.seed)
                     : default_seed;
  inverse.num_threads = num_threads;
  return inverse;
}

}  // namespace

StatusOr<InverseProblem> LoadInverseProblem(const Problem& problem,
                                            uint64_t default_seed,
                                            int num_threads) {
  IBRDF_RETURN_IF_ERROR(CheckSolvable(problem));
  InverseProblem inverse = SettingsOf(problem, default_seed, num_threads);
  IBRDF_RETURN_IF_ERROR(
      CheckMapSize(problem, inverse.transport.quadrature.far_width));
  StatusOr<Photograph> observed = LoadPhotograph(problem.image);
  if (!observed.ok()) return observed.status();
  inverse.warnings = std::move(observed->warnings);
  StatusOr<ObjectPoints> object =
      FindObjectPoints(problem, *observed, num_threads, &inverse.warnings);
  if (!object.ok()) return object.status();
  inverse.image = std::move(observed->radiance);
  inverse.bounds = std::move(observed->bounds);
  inverse.unknown_curve = std::move(observed->unknown_curve);
  inverse.points = std::move(object->points);
  IBRDF_RETURN_IF_ERROR(LoadReflectance(problem.reflectance, &inverse));
  IBRDF_RETURN_IF_ERROR(LoadIllumination(problem, &inverse));
  IBRDF_RETURN_IF_ERROR(PlanAndTraceEffects(problem, object->scene, &inverse));
  return inverse;
}

}  // namespace ibrdf
