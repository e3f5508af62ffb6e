// Radiance of a known scene, with the effects of a plan.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/effects/effects_plan.h"

namespace ibrdf {

// A reflectance as it is known.
struct KnownBrdf {
  BrdfFunction function;  // empty: the table
  MerlTable table;
  BrdfGrid Grid() const;
  // Either as a function. It must not outlive this.
  BrdfFunction Lookup() const;
};

class SceneRadiance {
 public:
  // Called with the share of a call's points that are done, in [0, 1], from the
  // calling thread; false stops. May be empty.
  using Progress = std::function<bool(double)>;

  // `points`: of the image; where the object lights itself, what they see of it
  // decides where patches are. `map` and `brdf`, which must live as long as
  // this: as in the problem; `grid`: the BRDF's, empty where nothing casts
  // shadows.
  SceneRadiance(const Scene& scene, const std::vector<ShadingPoint>& points,
                const Image& map, const KnownBrdf* brdf, const BrdfGrid& grid,
                const EffectsPlan& effects, RenderQuality quality,
                int num_threads);

  // Those that Render simulates: at first all of the plan's.
  int bounces() const { return bounces_; }
  void set_bounces(int bounces);

  // Along which narrow lobes see the object (ReferenceOptions::lobe_rays); 0
  // without bounces.
  static constexpr int kMostLobeRays = 16;  // those of reference quality
  int lobe_rays() const { return options_.lobe_rays; }
  void set_lobe_rays(int rays);

  // [points, 3]; false: stopped.
  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const;

 private:
  // Places and lights patches.
  void LightObject(const Scene& scene, const std::vector<ShadingPoint>& points,
                   const Image& map, const BrdfGrid& grid, int bounces,
                   bool reference);

  const Image& map_;
  const KnownBrdf* brdf_;
  int num_threads_;
  int bounces_ = 0;
  std::vector<std::vector<double>> emitted_;  // [bounces][patches, 3]
  ReferenceOptions options_;
  std::unique_ptr<const ReferenceRenderer> renderer_;
};

}  // namespace ibrdf
