#include "ibrdf/solvers/report/result_images.h"

#include <algorithm>
#include <cmath>

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

}  // namespace ibrdf
