// Radiance of a scene that nothing shadows, under one view direction, by the
// quadrature's two rules apart: the near one for each point, the far one by
// normal. Nearly all seconds of a point are the far rule's, whose radiance
// hardly changes from normal to normal, even where a mirror shows a forest.
#pragma once
#include <optional>
#include <vector>

#include "ibrdf/approximation/reflectance_map.h"
#include "ibrdf/base/status.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/forward/known_brdf.h"
#include "ibrdf/solvers/forward/scene_radiance.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

class SplitRadiance final : public RadianceRenderer {
 public:
  // Both must outlive this.
  SplitRadiance(const SceneRadiance& scene, const KnownBrdf& brdf);

  // Finds the far rule's radiance by the normals of `points`, which have one
  // wo, within a share log_error of itself (ReflectanceMapOptions). Until then
  // Render takes both rules for each point. kInterrupted: `progress` stopped
  // it.
  Status Fit(const std::vector<ShadingPoint>& points, const Progress& progress,
             double log_error);
  bool fitted() const { return far_map_.has_value(); }

  // The wo of `points` must be that of Fit's.
  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const override;

 private:
  // The far rule alone.
  class FarRadiance final : public RadianceRenderer {
   public:
    FarRadiance(const SceneRadiance& scene, const KnownBrdf& brdf)
        : scene_(scene), brdf_(brdf) {}
    bool Render(const std::vector<ShadingPoint>& points,
                const Progress& progress, double* L_o) const override {
      return scene_.RenderWith(brdf_, points, progress, L_o,
                               QuadratureRules::kFar);
    }

   private:
    const SceneRadiance& scene_;
    const KnownBrdf& brdf_;
  };

  const SceneRadiance& scene_;
  const KnownBrdf& brdf_;
  const FarRadiance far_;
  std::optional<ReflectanceMap> far_map_;
};

}  // namespace ibrdf
