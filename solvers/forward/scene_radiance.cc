#include "ibrdf/solvers/forward/scene_radiance.h"

#include <glog/logging.h>

#include <algorithm>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/render/reference_radiance.h"
#include "ibrdf/transport/quadrature.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

constexpr size_t kReferencePatchPoints = 8192;
// Width of maps whose sides do not halve and which no transport takes as they
// are.
constexpr int kObjectLightWidth = 1024;

}  // namespace

SceneRadianceOptions SceneRadianceOptions::Of(RenderQuality quality,
                                              int num_threads) {
  SceneRadianceOptions options;
  options.num_threads = num_threads;
  if (quality == RenderQuality::kPreview) return options;
  options.coarse_quadrature = false;
  options.shadow_rows = kReferenceShadowRows;
  options.patch_points = kReferencePatchPoints;
  options.fine_patches = true;
  options.lobe_rays = SceneRadiance::kMostLobeRays;
  return options;
}

SceneRadiance::SceneRadiance(const ForwardScene& scene,
                             const std::vector<ShadingPoint>& points,
                             const EffectsPlan& effects,
                             const SceneRadianceOptions& options)
    : scene_(scene), bounces_(effects.bounces) {
  CHECK_GE(options.shadow_rows, 1);
  CHECK(options.patch_points > 0 && options.least_patches > 0);
  CHECK(options.lobe_rays >= 0 &&
        (options.lobe_rays & (options.lobe_rays - 1)) == 0)
      << options.lobe_rays << " is no power of 2";
  if (options.coarse_quadrature) reference_ = Coarser(reference_);
  reference_.num_threads = options.num_threads;
  if (effects.visibility) {
    reference_.shadows =
        std::make_shared<VisibilityGrid>(scene.view.scene, options.shadow_rows);
  }
  if (effects.bounces > 0) LightObject(points, options);
  renderer_ = std::make_unique<ReferenceRenderer>(scene.map, reference_);
}

// They are placed and lit as in a solve, at reference quality with more of
// them.
void SceneRadiance::LightObject(const std::vector<ShadingPoint>& points,
                                const SceneRadianceOptions& options) {
  const Scene& scene = scene_.view.scene;
  const std::vector<ShadingPoint> few =
      SpreadPoints(points, options.patch_points);
  VisibilityOptions rays;
  rays.num_threads = options.num_threads;
  RadiosityOptions patches =
      PatchesFor(std::max(points.size(), options.least_patches), bounces_);
  patches.num_threads = options.num_threads;
  patches.max_points = static_cast<int>(options.patch_points);
  if (options.fine_patches) {
    patches.patch_size = 0.05;
    patches.views = 4;
    patches.max_patches = 16000;
    patches.lattice_rows = 64;
  }
  TransportOptions transport;
  transport.grid = scene_.grid.shape;
  transport.num_threads = options.num_threads;
  transport.visibility = std::make_shared<Visibility>(scene, few, rays);
  transport.patches = std::make_shared<RadiosityPatches>(
      scene, few, transport.visibility, patches);
  reference_.patches = transport.patches;
  reference_.lobe_rays = options.lobe_rays;
  // What the object lights itself by is a blur of the map.
  const Image& map = scene_.map;
  const bool fits =
      NumFarCells(map.height, map.width, transport.quadrature.far_width) +
          transport.patches->count() <=
      kMaxFarSources;
  const Image smaller =
      fits ? Image() : ResizeMap(map, kObjectLightWidth / 2, kObjectLightWidth);
  const Image& light = fits ? map : smaller;
  emitted_ = Transport({}, light.height, light.width, transport)
                 .Emitted(scene_.grid, light.rgb.data());
}

void SceneRadiance::set_bounces(int bounces) {
  CHECK(bounces == 0 ||
        (bounces > 0 && bounces < static_cast<int>(emitted_.size())));
  bounces_ = bounces;
}

void SceneRadiance::set_lobe_rays(int rays) {
  CHECK(emitted_.size() > 0 && rays > 0);
  reference_.lobe_rays = rays;
  renderer_ = std::make_unique<ReferenceRenderer>(scene_.map, reference_);
}

bool SceneRadiance::Render(const std::vector<ShadingPoint>& points,
                           const Progress& progress, double* L_o) const {
  if (scene_.texture) {
    return ReferenceRadiance(*renderer_, scene_.texture->Brdf(),
                             scene_.sharpest, Emitted())
        .Render(points, progress, L_o);
  }
  return RenderWith(scene_.brdf, points, progress, L_o);
}

bool SceneRadiance::RenderWith(const KnownBrdf& brdf,
                               const std::vector<ShadingPoint>& points,
                               const Progress& progress, double* L_o,
                               QuadratureRules rules) const {
  if (brdf.function) {
    return ReferenceRadiance(*renderer_, brdf.function, Emitted(), rules)
        .Render(points, progress, L_o);
  }
  return ReferenceRadiance(*renderer_, brdf.table, Emitted(), rules)
      .Render(points, progress, L_o);
}

EmittedLight SceneRadiance::Emitted() const {
  if (bounces_ == 0) return {};
  return {emitted_[bounces_].data(), bounces_};
}

}  // namespace ibrdf
