#include "ibrdf/solvers/problem/load_problem.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "ibrdf/io/model_file.h"
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
constexpr int kMostFineWidth = 1024;
// Blocks of texels that a transport takes of a map; the rest of its sources are
// patches and bright samples.
constexpr int kMostFarCells = 3 * kMaxFarSources / 4;

StatusOr<NamedModel> LoadModel(const std::string& name) {
  StatusOr<OpenedModel> opened = OpenModel(name);
  if (!opened.ok()) return opened.status();
  return NamedModel{
      name, std::make_shared<const NeuralBrdfModel>(std::move(opened->model))};
}

// `model` is empty (auto), a name, a file or a folder of two models. The second
// is empty where there is one.
std::array<std::string, 2> NamesOfModels(const std::string& model) {
  if (model.empty()) return {"default", "broad"};
  std::error_code error;
  if (!std::filesystem::is_directory(model, error)) return {model, ""};
  return ModelsOfFolder(model);
}

// Sets the models, or the grid of a known reflectance.
Status LoadReflectance(const Problem& problem, InverseProblem* inverse) {
  const ReflectanceSpec& reflectance = problem.reflectance;
  if (reflectance.known()) {
    const StatusOr<MerlTable> table = LoadKnownReflectance(reflectance);
    if (!table.ok()) return table.status();
    inverse->known_brdf = BrdfGrid::FromMerl(*table, inverse->transport.grid);
    return OkStatus();
  }
  const auto [first, second] = NamesOfModels(reflectance.model);
  StatusOr<NamedModel> model = LoadModel(first);
  if (!model.ok()) return model.status();
  inverse->model = std::move(model->model);
  inverse->model_name = std::move(model->name);
  if (second.empty()) return OkStatus();
  StatusOr<NamedModel> broad = LoadModel(second);
  if (!broad.ok()) return broad.status();
  inverse->other_models.push_back(*std::move(broad));
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

Image FineMap(const Image& map) {
  return map.width <= kMostFineWidth
             ? map
             : ResizeMap(map, kMostFineWidth / 2, kMostFineWidth);
}

// Sets the known map, and the size that it is taken at.
Status LoadIllumination(const Problem& problem, InverseProblem* inverse) {
  const IlluminationSpec& illumination = problem.illumination;
  if (!illumination.known()) return OkStatus();
  const StatusOr<Image> map = LoadKnownIllumination(
      illumination, &inverse->warnings, &inverse->known_map_frame);
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
  inverse->fine_known_map = std::make_shared<const Image>(FineMap(*map));
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

// An HDR image's bounds are its values.
RadianceBounds* BoundsOf(InverseProblem* inverse) {
  if (!inverse->bounds) inverse->bounds = {inverse->image, inverse->image};
  return &*inverse->bounds;
}

// Where a pixel shows stray light alone, its value bounds the known light's.
void BoundDarkPixels(const std::vector<Lighting>& lighting,
                     const StrayLight& stray, InverseProblem* inverse) {
  const Image& image = inverse->image;
  for (size_t i = 0; i < lighting.size(); ++i) {
    const size_t first = size_t{3} * inverse->points[i].pixel;
    const Eigen::Array3d radiance =
        Eigen::Map<const Eigen::Array3f>(&image.rgb[first]).cast<double>();
    if (lighting[i] != Lighting::kLit || !(radiance > 0.0).all() ||
        !IsBelowFloor(radiance, stray)) {
      continue;
    }
    ++inverse->dark.num_below_floor;
    RadianceBounds* const bounds = BoundsOf(inverse);
    for (size_t c = 0; c < 3; ++c) {
      float* const high = &bounds->high.rgb[first + c];
      *high += static_cast<float>(stray.ambient[static_cast<int>(c)]);
      bounds->low.rgb[first + c] = 0.0f;
    }
  }
}

// Finds what the known light leaves dark, and the stray light there unless it
// is stated.
Status FindDarkPixels(const std::optional<Eigen::Array3d>& ambient,
                      InverseProblem* inverse) {
  if (inverse->kind != ProblemKind::kReflectance) return OkStatus();
  DarkPixels* const dark = &inverse->dark;
  if (ambient) dark->ambient = *ambient;
  const std::vector<Lighting> lighting =
      FindLighting(inverse->points, *inverse->known_map, inverse->transport);
  const auto unlit =
      std::count_if(lighting.begin(), lighting.end(),
                    [](Lighting l) { return l != Lighting::kLit; });
  if (unlit == 0) return OkStatus();
  if (static_cast<size_t>(unlit) == lighting.size()) {
    return InvalidInput("illumination.known",
                        "expected light that reaches the object's pixels, "
                        "found none that does");
  }
  dark->num_unlit = static_cast<int>(unlit);
  dark->unlit.assign(inverse->image.num_pixels(), 0);
  for (size_t i = 0; i < lighting.size(); ++i) {
    if (lighting[i] != Lighting::kLit) {
      dark->unlit[inverse->points[i].pixel] = 1;
    }
  }
  // Radiance of codes by a curve that is to be found is not known yet.
  if (ambient || inverse->unknown_curve) return OkStatus();
  const StrayLight stray =
      MeasureStrayLight(inverse->image, inverse->points, lighting);
  dark->ambient = stray.ambient;
  dark->ambient_deviation = stray.deviation;
  BoundDarkPixels(lighting, stray, inverse);
  return OkStatus();
}

// Photographs of the same pixels under other lights.
Status LoadOtherPhotographs(const Problem& problem, InverseProblem* inverse) {
  for (const std::string& file : problem.image.other_lights) {
    ImageSpec spec = problem.image;
    spec.file = file;
    spec.mask.clear();  // the object's pixels are known
    StatusOr<Photograph> photograph = LoadPhotograph(spec);
    if (!photograph.ok()) return photograph.status();
    const Image& image = photograph->radiance;
    if (image.width != inverse->image.width ||
        image.height != inverse->image.height) {
      return InvalidInput(
          file, "expected the size of " + problem.image.file + ", " +
                    SizeName(inverse->image.width, inverse->image.height) +
                    ", found " + SizeName(image.width, image.height));
    }
    for (std::string& warning : photograph->warnings) {
      inverse->warnings.push_back(std::move(warning));
    }
    inverse->other_photographs.push_back(
        std::make_shared<const OtherPhotograph>(
            OtherPhotograph{file, std::move(photograph->radiance),
                            std::move(photograph->bounds)}));
  }
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
                                            PhotographedObject object,
                                            uint64_t default_seed,
                                            int num_threads) {
  InverseProblem inverse = SettingsOf(problem, default_seed, num_threads);
  IBRDF_RETURN_IF_ERROR(
      CheckMapSize(problem, inverse.transport.quadrature.far_width));
  inverse.warnings = std::move(object.warnings);
  inverse.image = std::move(object.radiance);
  inverse.sheet = std::move(object.sheet);
  inverse.bounds = std::move(object.bounds);
  inverse.unknown_curve = std::move(object.unknown_curve);
  inverse.points = std::move(object.points);
  inverse.materials = std::move(object.materials);
  inverse.look = std::move(object.look);
  inverse.variation = ChosenVariation(problem, inverse.look->check);
  IBRDF_RETURN_IF_ERROR(LoadOtherPhotographs(problem, &inverse));
  IBRDF_RETURN_IF_ERROR(LoadReflectance(problem, &inverse));
  IBRDF_RETURN_IF_ERROR(LoadIllumination(problem, &inverse));
  IBRDF_RETURN_IF_ERROR(PlanAndTraceEffects(problem, object.scene, &inverse));
  const Status dark = FindDarkPixels(problem.illumination.ambient, &inverse);
  if (!dark.ok()) return InvalidInput(problem.path, dark.message());
  return inverse;
}

StatusOr<InverseProblem> LoadInverseProblem(const Problem& problem,
                                            uint64_t default_seed,
                                            int num_threads) {
  StatusOr<PhotographedObject> object =
      LoadPhotographedObject(problem, num_threads);
  if (!object.ok()) return object.status();
  return LoadInverseProblem(problem, *std::move(object), default_seed,
                            num_threads);
}

}  // namespace ibrdf
