#include "ibrdf/approximation/gaussian_radiance.h"

#include <algorithm>

namespace ibrdf {

GaussianRadiance::GaussianRadiance(const Image& map, const BrdfFunction& brdf,
                                   const GaussianFitOptions& fit,
                                   const GaussianOptions& options)
    : light_(map, fit),
      transport_(light_.lobes(), options),
      tables_(transport_.Tabulate(brdf)),
      amplitudes_(light_.Fit(map.rgb.data())) {}

bool GaussianRadiance::Render(const std::vector<ShadingPoint>& points,
                              const Progress& progress, double* L_o) const {
  if (progress && !progress(0.0)) return false;
  transport_.Render(points, tables_, amplitudes_, L_o);
  std::transform(L_o, L_o + 3 * points.size(), L_o,
                 [](double v) { return std::max(v, 0.0); });
  return true;
}

}  // namespace ibrdf
