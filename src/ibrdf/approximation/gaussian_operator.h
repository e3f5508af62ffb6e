// GaussianTransport as a function of the map.
#pragma once
#include <vector>

#include "ibrdf/approximation/gaussian_light.h"
#include "ibrdf/approximation/gaussian_transport.h"
#include "ibrdf/transport/linear_transport.h"

namespace ibrdf {

// The map's amplitudes are GaussianLight::Fit, which is linear: its lobes stay
// those of the map that it was made for. Radiance may be negative.
class GaussianOperator final : public LinearTransport {
 public:
  // light, transport and brdf must outlive the operator; the transport is of
  // the light's lobes.
  GaussianOperator(const GaussianLight& light,
                   const GaussianTransport& transport,
                   std::vector<ShadingPoint> points, const BrdfFunction& brdf);

  int num_points() const override { return static_cast<int>(points_.size()); }
  void ApplyLinear(const float* map, double* L_o) const override;
  void ApplyTranspose(const double* adjoint, float* gradient) const override;

 private:
  const GaussianLight& light_;
  const GaussianTransport& transport_;
  const std::vector<ShadingPoint> points_;
  const GaussianTransport::Tables tables_;
};

}  // namespace ibrdf
