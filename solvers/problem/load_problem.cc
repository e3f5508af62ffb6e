#include "ibrdf/solvers/problem/load_problem.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "ibrdf/io/image_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/solvers/problem/open_model.h"
#include "ibrdf/solvers/problem/quadrature_level.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {
namespace {

constexpr int kLeastKnownWidth = 128;
// Beyond it texels are finer than pixels and rings (PointQuadrature) show them.
constexpr int kMostKnownWidth = 256;
// What a transport takes of a map; the rest is for patches and bright samples.
constexpr int kMostFarCells = 3 * kMaxFarSources / 4;

Status LoadImage(const ImageSpec& spec, Image* image, Mask* mask) {
  StatusOr<Image> read = ReadImage(spec.file);
  if (!read.ok()) return read.status();
  *image = std::move(read).value();
  if (spec.mask.empty()) return OkStatus();
  StatusOr<Mask> read_mask = ReadMask(spec.mask);
  if (!read_mask.ok()) return read_mask.status();
  *mask = std::move(read_mask).value();
  if (mask->width != image->width || mask->height != image->height) {
    return InvalidInput(
        spec.mask, "expected the image's size " + std::to_string(image->width) +
                       "x" + std::to_string(image->height) + ", found " +
                       std::to_string(mask->width) + "x" +
                       std::to_string(mask->height));
  }
  return OkStatus();
}

// Sides that do not halve leave a map of many texels in as many cells.
Status CheckMapSize(const Problem& problem, int far_width) {
  const int width = problem.illumination.width;
  const int height = problem.illumination.height;
  const int cells = NumFarCells(height, width, far_width);
  if (cells <= kMostFarCells) return OkStatus();
  const std::string found =
      std::to_string(width) + "x" + std::to_string(height);
  return InvalidInput(problem.path + ": illumination.width",
                      "expected a map whose width and height can both be "
                      "halved until at most " +
                          std::to_string(kMostFarCells) +
                          " texels are left, as powers of two can, found " +
                          found);
}

// Of a known map that no size is asked for: its own, to a power of two.
int KnownMapWidth(int width) {
  int out = kLeastKnownWidth;
  while (out < kMostKnownWidth && 2 * out <= width) out *= 2;
  return out;
}

}  // namespace

StatusOr<InverseProblem> LoadInverseProblem(const Problem& problem,
                                            uint64_t default_seed,
                                            int num_threads) {
  IBRDF_RETURN_IF_ERROR(CheckSolvable(problem));
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
  IBRDF_RETURN_IF_ERROR(
      CheckMapSize(problem, inverse.transport.quadrature.far_width));

  Mask mask;
  IBRDF_RETURN_IF_ERROR(LoadImage(problem.image, &inverse.image, &mask));
  const StatusOr<Scene> scene = LoadScene(problem.geometry);
  if (!scene.ok()) return scene.status();
  StatusOr<std::vector<ShadingPoint>> points =
      FindShadingPoints(*scene, problem.camera, inverse.image.width,
                        inverse.image.height, mask, 1, num_threads);
  if (!points.ok()) {
    return InvalidInput(problem.path, points.status().message());
  }
  inverse.points = std::move(points).value();

  if (problem.reflectance.known()) {
    const StatusOr<MerlTable> table = LoadKnownReflectance(problem.reflectance);
    if (!table.ok()) return table.status();
    inverse.known_brdf = BrdfGrid::FromMerl(*table, inverse.transport.grid);
  } else {
    StatusOr<OpenedModel> model = OpenModel(problem.reflectance.model.empty()
                                                ? "default"
                                                : problem.reflectance.model);
    if (!model.ok()) return model.status();
    inverse.model = std::move(model->model);
  }
  if (problem.illumination.known()) {
    const StatusOr<Image> map = LoadKnownIllumination(problem.illumination);
    if (!map.ok()) return map.status();
    if (std::none_of(map->rgb.begin(), map->rgb.end(),
                     [](float v) { return v > 0.0f; })) {
      return InvalidInput(problem.path + ": illumination.known",
                          "expected light from somewhere, found a black map");
    }
    if (!problem.illumination.sized &&
        !problem.illumination.known_file.empty()) {
      inverse.map_width = KnownMapWidth(map->width);
      inverse.map_height = inverse.map_width / 2;
    }
    inverse.known_map =
        map->width == inverse.map_width && map->height == inverse.map_height
            ? *map
            : ResizeMap(*map, inverse.map_height, inverse.map_width);
  }
  StatusOr<EffectsPlan> effects = PlanEffects(
      problem, *scene, inverse.points,
      inverse.known_map.has_value() ? &*inverse.known_map : nullptr,
      inverse.known_brdf.has_value() ? &*inverse.known_brdf : nullptr,
      kSolveOmissionError, num_threads);
  if (!effects.ok()) return effects.status();
  inverse.effects = *std::move(effects);
  if (inverse.effects.visibility) {
    VisibilityOptions rays;
    rays.num_threads = num_threads;
    // A block of texels that is hidden in part is taken texel by texel.
    if (inverse.known_map.has_value() && !problem.illumination.sized &&
        inverse.map_width > kLeastKnownWidth) {
      inverse.map_width = kLeastKnownWidth;
      inverse.map_height = kLeastKnownWidth / 2;
      inverse.known_map =
          ResizeMap(*inverse.known_map, inverse.map_height, inverse.map_width);
    }
    inverse.transport.visibility =
        std::make_shared<Visibility>(*scene, inverse.points, rays);
    if (inverse.effects.bounces > 0) {
      RadiosityOptions patches =
          PatchesFor(inverse.points.size(), inverse.effects.bounces);
      patches.num_threads = num_threads;
      inverse.transport.patches = std::make_shared<RadiosityPatches>(
          *scene, inverse.points, inverse.transport.visibility, patches);
    }
  }
  return inverse;
}

}  // namespace ibrdf
