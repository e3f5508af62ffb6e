// A small scene with the library's transport and the reference's, and what
// follows from the latter in long double.
#pragma once
#include <vector>

#include "experiments/validation/derivatives/reference_transport.h"
#include "ibrdf/image/image.h"
#include "ibrdf/solvers/costs/robust_log_residual.h"

namespace ibrdf {
namespace derivatives {

struct LobeRadiance {
  std::vector<Real> L_o;   // [points * 3]
  std::vector<Real> dL_o;  // [points * 3][lobe parameters]
};

// Grid 12x8x6 and a coarse quadrature.
TransportOptions SmallTransportOptions();

class ReferenceScene {
 public:
  // The map gives the size, and a light.
  ReferenceScene(std::vector<ShadingPoint> points, Image map);

  const std::vector<ShadingPoint>& points() const { return points_; }
  const Image& map() const { return map_; }
  const TransportOptions& options() const { return options_; }
  const Transport& transport() const { return transport_; }
  const ReferenceTransport& reference() const { return reference_; }

  // fields as ReferenceFields with derivatives; parameters as LobeModel's;
  // light [H, W, 3].
  LobeRadiance Radiance(const std::vector<Real>& fields, int code_size,
                        const std::vector<double>& parameters,
                        const std::vector<Real>& light) const;

  // [3][nodes] of the lobes' BRDF.
  std::vector<std::vector<Real>> Brdf(
      const std::vector<Real>& fields, int code_size,
      const std::vector<double>& parameters) const;

 private:
  const std::vector<ShadingPoint> points_;
  const Image map_;
  const TransportOptions options_ = SmallTransportOptions();
  const Transport transport_;
  const ReferenceTransport reference_;
};

// Residual and its derivative by L_o (see RobustLogLikelihood).
Real Residual(Real L_o, Real observed, const RobustLogLikelihood& likelihood);
Real ResidualSlope(Real L_o, Real observed,
                   const RobustLogLikelihood& likelihood);

}  // namespace derivatives
}  // namespace ibrdf
