#include "ibrdf/solvers/report/result_images.h"

#include <glog/logging.h>

#include <cmath>

#include "ibrdf/image/radiance_interval.h"
#include "ibrdf/light/convert_map.h"

namespace ibrdf {
namespace {

RadianceInterval IntervalAt(const InverseProblem& inverse, size_t value) {
  if (!inverse.bounds) {
    return {inverse.image.rgb[value], inverse.image.rgb[value]};
  }
  return {inverse.bounds->low.rgb[value], inverse.bounds->high.rgb[value]};
}

}  // namespace

Mask ObjectMask(const InverseProblem& inverse) {
  Mask mask(inverse.image.width, inverse.image.height, 0);
  for (const ShadingPoint& p : inverse.points) mask.inside[p.pixel] = 1;
  return mask;
}

Mask UsedMask(const InverseProblem& inverse) {
  Mask mask(inverse.image.width, inverse.image.height, 0);
  for (const ShadingPoint& p : inverse.points) {
    const std::vector<char>& unlit = inverse.dark.unlit;
    bool used = unlit.empty() || unlit[p.pixel] == 0;
    for (size_t k = size_t{3} * p.pixel; k < size_t{3} * p.pixel + 3; ++k) {
      const float v = inverse.image.rgb[k];
      used &=
          std::isfinite(v) && v > 0.0f && !IntervalAt(inverse, k).IsMissing();
    }
    mask.inside[p.pixel] = used ? 1 : 0;
  }
  return mask;
}

Image NearestObserved(const InverseProblem& inverse, const Solution& solution) {
  Image nearest = inverse.image;
  if (!inverse.bounds) return nearest;
  const Mask used = UsedMask(inverse);
  for (size_t k = 0; k < nearest.rgb.size(); ++k) {
    if (used.inside[k / 3] == 0) continue;
    nearest.rgb[k] = static_cast<float>(
        IntervalAt(inverse, k).Nearest(solution.render.rgb[k]));
  }
  return nearest;
}

Image LogResidual(const InverseProblem& inverse, const Solution& solution) {
  Image residual(inverse.image.width, inverse.image.height);
  const Mask used = UsedMask(inverse);
  const Image observed = NearestObserved(inverse, solution);
  for (size_t k = 0; k < residual.rgb.size(); ++k) {
    if (used.inside[k / 3] == 0) continue;
    residual.rgb[k] =
        static_cast<float>(std::log(solution.render.rgb[k] + solution.epsilon) -
                           std::log(observed.rgb[k] + solution.epsilon));
  }
  return residual;
}

Image MapForPicture(const Image& map) {
  StatusOr<Image> out = FromLibraryFrame("map", map, MapFrame::kCamera);
  CHECK(out.ok()) << out.status().message();
  return *std::move(out);
}

std::string MiddleOfMapPicture(const Camera& camera) {
  constexpr double kLeastCosine = 0.985;  // 10 degrees
  const Eigen::Matrix3d axes = AxesOf(camera).world_from_camera;
  const double upright = camera.world_from_camera ? axes(1, 1)
                         : camera.type == CameraType::kOrthographic
                             ? 1.0
                             : camera.up.normalized().y();
  const bool ahead = axes(2, 2) > kLeastCosine && upright > kLeastCosine;
  return ahead ? "what the camera looks at" : "-z";
}

}  // namespace ibrdf
