#include "ibrdf/approximation/harmonic_radiance.h"

#include <algorithm>

namespace ibrdf {

bool HarmonicRadiance::Render(const std::vector<ShadingPoint>& points,
                              const Progress& progress, double* L_o) const {
  if (progress && !progress(0.0)) return false;
  HarmonicTransport(points, map_.height, map_.width, options_)
      .Render(grid_, map_.rgb.data(), L_o);
  std::transform(L_o, L_o + 3 * points.size(), L_o,
                 [](double v) { return std::max(v, 0.0); });
  return true;
}

}  // namespace ibrdf
