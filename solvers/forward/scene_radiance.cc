#include "ibrdf/solvers/forward/scene_radiance.h"

#include <glog/logging.h>

#include <algorithm>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/quadrature.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

// Points between two calls of progress: well below a second at reference
// quality, enough to keep the threads busy.
constexpr size_t kPointsPerStep = 2048;
constexpr int kPreviewShadowRows = 128;
// Whose sight decides where patches are.
constexpr size_t kPatchPoints = 2048;
constexpr size_t kReferencePatchPoints = 8192;
constexpr int kPreviewLobeRays = 8;
// A small image of an intricate object shows as much of it as a large one.
constexpr size_t kLeastPatches = 2048;
// Of maps whose sides do not halve and which no transport takes as they are.
constexpr int kObjectLightWidth = 1024;

}  // namespace

BrdfGrid KnownBrdf::Grid() const {
  return function ? BrdfGrid::FromFunction(function, {})
                  : BrdfGrid::FromMerl(table, {});
}

BrdfFunction KnownBrdf::Lookup() const {
  if (function) return function;
  return [this](double theta_h, double theta_d, double phi_d) {
    return InterpolateMerl(table, theta_h, theta_d, phi_d);
  };
}

SceneRadiance::SceneRadiance(const Scene& scene,
                             const std::vector<ShadingPoint>& points,
                             const Image& map, const KnownBrdf* brdf,
                             const BrdfGrid& grid, const EffectsPlan& effects,
                             RenderQuality quality, int num_threads)
    : map_(map),
      brdf_(brdf),
      num_threads_(num_threads),
      bounces_(effects.bounces) {
  const bool reference = quality == RenderQuality::kReference;
  if (!reference) options_ = Coarser(options_);
  options_.num_threads = num_threads;
  if (effects.visibility) {
    options_.shadows = std::make_shared<VisibilityGrid>(
        scene, reference ? kReferenceShadowRows : kPreviewShadowRows);
  }
  if (effects.bounces > 0) {
    LightObject(scene, points, map, grid, effects.bounces, reference);
  }
  renderer_ = std::make_unique<ReferenceRenderer>(map, options_);
}

// They are placed and lit as in a solve, at reference quality with more of
// them.
void SceneRadiance::LightObject(const Scene& scene,
                                const std::vector<ShadingPoint>& points,
                                const Image& map, const BrdfGrid& grid,
                                int bounces, bool reference) {
  const size_t most = reference ? kReferencePatchPoints : kPatchPoints;
  const std::vector<ShadingPoint> few = SpreadPoints(points, most);
  VisibilityOptions rays;
  rays.num_threads = num_threads_;
  RadiosityOptions patches =
      PatchesFor(std::max(points.size(), kLeastPatches), bounces);
  patches.num_threads = num_threads_;
  patches.max_points = static_cast<int>(most);
  if (reference) {
    patches.patch_size = 0.05;
    patches.views = 4;
    patches.max_patches = 16000;
    patches.lattice_rows = 64;
  }
  TransportOptions transport;
  transport.grid = grid.shape;
  transport.num_threads = num_threads_;
  transport.visibility = std::make_shared<Visibility>(scene, few, rays);
  transport.patches = std::make_shared<RadiosityPatches>(
      scene, few, transport.visibility, patches);
  options_.patches = transport.patches;
  // What the object lights itself by is a blur of the map.
  const bool fits =
      NumFarCells(map.height, map.width, transport.quadrature.far_width) +
          transport.patches->count() <=
      kMaxFarSources;
  const Image smaller =
      fits ? Image() : ResizeMap(map, kObjectLightWidth / 2, kObjectLightWidth);
  const Image& light = fits ? map : smaller;
  options_.lobe_rays = reference ? kMostLobeRays : kPreviewLobeRays;
  emitted_ = Transport({}, light.height, light.width, transport)
                 .Emitted(grid, light.rgb.data());
}

void SceneRadiance::set_bounces(int bounces) {
  CHECK(bounces == 0 ||
        (bounces > 0 && bounces < static_cast<int>(emitted_.size())));
  bounces_ = bounces;
}

void SceneRadiance::set_lobe_rays(int rays) {
  CHECK(emitted_.size() > 0 && rays > 0);
  options_.lobe_rays = rays;
  renderer_ = std::make_unique<ReferenceRenderer>(map_, options_);
}

bool SceneRadiance::Render(const std::vector<ShadingPoint>& points,
                           const Progress& progress, double* L_o) const {
  for (size_t begin = 0; begin < points.size(); begin += kPointsPerStep) {
    if (progress && !progress(static_cast<double>(begin) / points.size())) {
      return false;
    }
    const size_t end = std::min(begin + kPointsPerStep, points.size());
    const std::vector<ShadingPoint> some(points.begin() + begin,
                                         points.begin() + end);
    EmittedLight emitted;
    if (bounces_ > 0) emitted = {emitted_[bounces_].data(), bounces_};
    if (brdf_->function) {
      renderer_->Render(some, brdf_->function, L_o + 3 * begin, emitted);
    } else {
      renderer_->Render(some, brdf_->table, L_o + 3 * begin, emitted);
    }
  }
  return true;
}

}  // namespace ibrdf
