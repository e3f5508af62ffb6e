#include "ibrdf/solvers/forward/split_radiance.h"

#include <utility>

namespace ibrdf {

SplitRadiance::SplitRadiance(const SceneRadiance& scene, const KnownBrdf& brdf)
    : scene_(scene), brdf_(brdf), far_(scene, brdf) {}

Status SplitRadiance::Fit(const std::vector<ShadingPoint>& points,
                          const Progress& progress, double log_error) {
  ReflectanceMapOptions options;
  options.log_error = log_error;
  StatusOr<ReflectanceMap> map =
      ReflectanceMap::Fit(points, far_, progress, options);
  if (!map.ok()) return map.status();
  far_map_ = *std::move(map);
  return OkStatus();
}

bool SplitRadiance::Render(const std::vector<ShadingPoint>& points,
                           const Progress& progress, double* L_o) const {
  if (!far_map_) return scene_.RenderWith(brdf_, points, progress, L_o);
  std::vector<double> far(3 * points.size());
  if (!far_map_->Render(points, progress, far.data()) ||
      !scene_.RenderWith(brdf_, points, progress, L_o,
                         QuadratureRules::kNear)) {
    return false;
  }
  for (size_t k = 0; k < far.size(); ++k) L_o[k] += far[k];
  return true;
}

}  // namespace ibrdf
