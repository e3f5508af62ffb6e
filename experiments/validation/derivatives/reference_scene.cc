#include "experiments/validation/derivatives/reference_scene.h"

#include <cmath>
#include <utility>

#include "experiments/validation/derivatives/reference_flows.h"
#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {
namespace derivatives {

TransportOptions SmallTransportOptions() {
  TransportOptions options;
  options.quadrature.near_rings = 8;
  options.quadrature.near_ring_samples = 24;
  options.grid = {12, 8, 6};
  return options;
}

ReferenceScene::ReferenceScene(std::vector<ShadingPoint> points, Image map)
    : points_(std::move(points)),
      map_(std::move(map)),
      transport_(points_, map_.height, map_.width, options_),
      reference_(points_, map_.height, map_.width, options_) {}

LobeRadiance ReferenceScene::Radiance(const std::vector<Real>& fields,
                                      int code_size,
                                      const std::vector<double>& parameters,
                                      const std::vector<Real>& light) const {
  const size_t nodes = reference_.num_nodes(), columns = parameters.size();
  const size_t lobe_size = code_size + 3;
  LobeRadiance out;
  out.L_o.assign(3 * points_.size(), 0);
  out.dL_o.assign(out.L_o.size() * columns, 0);
  for (size_t i = 0; i < points_.size(); ++i) {
    const std::vector<Real> gathered =
        reference_.Gather(static_cast<int>(i), light);
    for (size_t k = 0; k < columns / lobe_size; ++k) {
      const double* lobe = &parameters[k * lobe_size];
      for (int c = 0; c < 3; ++c) {
        const Real colour = ReferenceColour(lobe[code_size + c], c);
        Real* d = &out.dL_o[(3 * i + c) * columns + k * lobe_size];
        for (int f = 0; f <= code_size; ++f) {
          const Real* field = &fields[(k * (1 + code_size) + f) * nodes];
          Real sum = 0;
          for (size_t n = 0; n < nodes; ++n) {
            sum += field[n] * gathered[3 * n + c];
          }
          if (f == 0) {
            out.L_o[3 * i + c] += colour * sum;
            // Constant beyond the clamp.
            const bool moves = lobe[code_size + c] < kMaxLogColour;
            d[code_size + c] = moves ? colour * sum : 0;
          } else {
            d[f - 1] = colour * sum;
          }
        }
      }
    }
  }
  return out;
}

std::vector<std::vector<Real>> ReferenceScene::Brdf(
    const std::vector<Real>& fields, int code_size,
    const std::vector<double>& parameters) const {
  const size_t nodes = reference_.num_nodes(), lobe_size = code_size + 3;
  std::vector<std::vector<Real>> brdf(3, std::vector<Real>(nodes, 0));
  for (size_t k = 0; k < parameters.size() / lobe_size; ++k) {
    const Real* shape = &fields[k * (1 + code_size) * nodes];
    for (int c = 0; c < 3; ++c) {
      const Real colour =
          ReferenceColour(parameters[k * lobe_size + code_size + c], c);
      for (size_t n = 0; n < nodes; ++n) brdf[c][n] += colour * shape[n];
    }
  }
  return brdf;
}

Real Residual(Real L_o, Real observed, const RobustLogLikelihood& likelihood) {
  const Real epsilon = likelihood.epsilon, delta = likelihood.delta;
  const Real t = (std::log(L_o + epsilon) - std::log(observed + epsilon)) /
                 likelihood.scale;
  const Real root = std::sqrt(t * t + delta * delta);
  return t * std::sqrt(2 / (root + delta));
}

Real ResidualSlope(Real L_o, Real observed,
                   const RobustLogLikelihood& likelihood) {
  const Real epsilon = likelihood.epsilon, delta = likelihood.delta;
  const Real t = (std::log(L_o + epsilon) - std::log(observed + epsilon)) /
                 likelihood.scale;
  const Real root = std::sqrt(t * t + delta * delta);
  // d/dt of sign(t) sqrt(2 (root - delta)) = |t| / root / sqrt(2 (root -
  // delta)) with root - delta = t^2 / (root + delta).
  const Real dr_dt = std::sqrt((root + delta) / 2) / root;
  return dr_dt / (likelihood.scale * (L_o + epsilon));
}

}  // namespace derivatives
}  // namespace ibrdf
