#include "ibrdf/solvers/report/result_images.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/light/convert_map.h"

namespace ibrdf {

Mask ObjectMask(const InverseProblem& inverse) {
  Mask mask(inverse.image.width, inverse.image.height, 0);
  for (const ShadingPoint& p : inverse.points) mask.inside[p.pixel] = 1;
  return mask;
}

Image LogResidual(const InverseProblem& inverse, const Solution& solution) {
  Image residual(inverse.image.width, inverse.image.height);
  for (const ShadingPoint& p : inverse.points) {
    const float* const observed = &inverse.image.rgb[size_t{3} * p.pixel];
    if (!std::all_of(observed, observed + 3,
                     [](float v) { return std::isfinite(v) && v > 0.0f; })) {
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const size_t at = size_t{3} * p.pixel + c;
      residual.rgb[at] = static_cast<float>(
          std::log(solution.render.rgb[at] + solution.epsilon) -
          std::log(observed[c] + solution.epsilon));
    }
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
  const bool ahead =
      camera.type == CameraType::kOrthographic ||
      ((camera.from - camera.to).normalized().z() > kLeastCosine &&
       camera.up.normalized().y() > kLeastCosine);
  return ahead ? "what the camera looks at" : "-z";
}

}  // namespace ibrdf
