// A prior on the map's log radiance.
#pragma once

namespace ibrdf {

// Of a planar map [3][H][W] of log radiance. Not thread-safe: a gradient leaves
// the point of later products.
class LightPrior {
 public:
  virtual ~LightPrior() = default;

  // -log p up to a constant, >= 0. With `gradient` [3][H][W], adds the gradient
  // to it and makes this the point of later products.
  virtual double Evaluate(const float* log_map, float* gradient) = 0;

  // out += H v, both [3][H][W]: H symmetric and positive semi-definite, the
  // Hessian or the one of the reweighted squares that touch the prior at the
  // point of the last gradient with its slope and lie above it. (With those,
  // gradient . H^-1 gradient <= 2 Evaluate, which a least-squares form needs.)
  virtual void AddProduct(const float* v, float* out) const = 0;
};

}  // namespace ibrdf
