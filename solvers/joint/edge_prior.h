// Robust differences between neighbouring texels of the map.
#pragma once
#include <cstddef>
#include <vector>

#include "solvers/joint/light_prior.h"

namespace ibrdf {

// On the map's log radiance l,
//   sum over edges share * rho(|l_i - l_j| / (scale sqrt(angle_ij))),
// rho(t) = sqrt(t^2 + delta^2) - delta, |.| over the three channels, share =
// solid angle of the texel relative to one at the equator; columns wrap. Log
// radiance of natural light differs over an angle by about its root, with the
// heavy tails of lamps, horizons and windows: the mean of
// |l_i - l_j| / sqrt(angle) per channel is 0.25 to 1.8, 0.70 on average, over
// seven outdoor and indoor maps at 64x32 (experiments/light_statistics).
class EdgePrior final : public LightPrior {
 public:
  // scale, delta > 0; scale in log radiance over the root of a radian.
  EdgePrior(int height, int width, double scale, double delta);

  double Evaluate(const float* log_map, float* gradient) override;
  void AddProduct(const float* v, float* out) const override;

 private:
  size_t Plane() const { return static_cast<size_t>(height_) * width_; }
  template <typename Function>
  void ForEachEdge(const Function& f) const;

  const int height_, width_;
  const double delta_;
  // Per row: share, and 1 / (scale^2 angle) along the row and down.
  std::vector<double> share_, along_, down_;
  std::vector<float> weights_;  // per edge, at the last gradient's point
};

}  // namespace ibrdf
