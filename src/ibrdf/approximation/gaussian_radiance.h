// Any points under a map of spherical Gaussians.
#pragma once
#include <vector>

#include "ibrdf/approximation/gaussian_light.h"
#include "ibrdf/approximation/gaussian_transport.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

// The fit of the map and the tables of the BRDF are made once, for all points.
class GaussianRadiance final : public RadianceRenderer {
 public:
  // The function's references must live as long as this; several threads may
  // call it at a time.
  GaussianRadiance(const Image& map, const BrdfFunction& brdf,
                   const GaussianFitOptions& fit,
                   const GaussianOptions& options);

  int num_lobes() const { return transport_.num_lobes(); }
  // Lobes of bright spots among them.
  int num_peaks() const { return light_.num_peaks(); }

  // Unshadowed points; what is below 0 is taken as 0. `progress` may stop it
  // before the first point alone.
  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const override;

 private:
  const GaussianLight light_;
  const GaussianTransport transport_;
  const GaussianTransport::Tables tables_;
  const GaussianColours amplitudes_;
};

}  // namespace ibrdf
