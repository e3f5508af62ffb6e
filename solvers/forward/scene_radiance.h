// Radiance of a known scene, with the effects of a plan.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/io/problem.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/effects/effects_plan.h"
#include "ibrdf/solvers/forward/forward_scene.h"
#include "ibrdf/solvers/forward/known_brdf.h"
#include "ibrdf/solvers/forward/known_paint.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

// How finely radiance is worked out. The defaults are a preview's.
struct SceneRadianceOptions {
  // Whether the quadrature is that of Coarser(): a quarter of the rings of
  // directions around a highlight.
  bool coarse_quadrature = true;
  // Rows of directions of shadow rays. Those of the reference brought the
  // mirror-like armadillo nothing (docs/notes, effects).
  int shadow_rows = 128;
  // Radiosity patches. Points of the image whose sight decides where they are;
  // patches at least, as a small image of an intricate object shows as much of
  // it as a large one: the error of the armadillo fell from 0.018 to 0.007
  // (docs/notes, effects).
  size_t patch_points = 2048;
  size_t least_patches = 2048;
  bool fine_patches = false;
  // Rays along which a narrow lobe sees the object, a power of 2. In a torus
  // with a lobe of 2 degrees patches alone leave 0.43, 4 rays 0.13 and 32 rays
  // 0.02 (docs/notes, effects).
  int lobe_rays = 8;
  int num_threads = 0;  // <= 0: all

  static SceneRadianceOptions Of(RenderQuality quality, int num_threads);
};

// The scene's reflectance is unpainted; its texture is rendered. What the
// object throws on itself has the paint's mean (ForwardScene::grid).
class SceneRadiance final : public RadianceRenderer {
 public:
  // `scene` must live as long as this. `points`: of the image; where the object
  // lights itself, what they see of it decides where patches are.
  SceneRadiance(const ForwardScene& scene,
                const std::vector<ShadingPoint>& points,
                const EffectsPlan& effects,
                const SceneRadianceOptions& options);

  // Bounces that Render simulates: at first all of the plan's.
  int bounces() const { return bounces_; }
  void set_bounces(int bounces);

  // Rays along which narrow lobes see the object (ReferenceOptions::lobe_rays);
  // 0 without bounces.
  static constexpr int kMostLobeRays = 16;  // those of reference quality
  int lobe_rays() const { return reference_.lobe_rays; }
  void set_lobe_rays(int rays);

  // `progress` is called as by ReferenceRadiance.
  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const override;
  // The same of another reflectance, what the object throws on itself as it is,
  // and of rules of the quadrature.
  bool RenderWith(const KnownBrdf& brdf,
                  const std::vector<ShadingPoint>& points,
                  const Progress& progress, double* L_o,
                  QuadratureRules rules = QuadratureRules::kBoth) const;

 private:
  EmittedLight Emitted() const;
  // Places patches that `points` see, and lights them.
  void LightObject(const std::vector<ShadingPoint>& points,
                   const SceneRadianceOptions& options);

  const ForwardScene& scene_;
  int bounces_ = 0;
  std::vector<std::vector<double>> emitted_;  // [bounces][patches, 3]
  ReferenceOptions reference_;
  std::unique_ptr<const ReferenceRenderer> renderer_;
};

// What a scene's matte part alone sends. Refers to both.
class MatteRadiance final : public RadianceRenderer {
 public:
  MatteRadiance(const SceneRadiance& scene, const KnownPaint& paint)
      : scene_(scene), paint_(paint) {}

  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const override {
    return scene_.RenderWith(paint_.matte, points, progress, L_o);
  }

 private:
  const SceneRadiance& scene_;
  const KnownPaint& paint_;
};

}  // namespace ibrdf
