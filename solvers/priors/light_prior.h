// A prior on the map's log radiance.
#pragma once
#include "ibrdf/light/log_map.h"

namespace ibrdf {

// Not thread-safe: a gradient leaves the point of later products.
class LightPrior {
 public:
  virtual ~LightPrior() = default;

  // -log p up to a constant, >= 0. With `gradient`, adds the gradient to it and
  // makes this the point of later products.
  virtual double Evaluate(const LogMap& log_map, LogMap* gradient) = 0;

  // out += H v: H symmetric and positive semi-definite, the
  // Hessian or the one of the reweighted squares that touch the prior at the
  // point of the last gradient with its slope and lie above it. (With those,
  // gradient . H^-1 gradient <= 2 Evaluate, which a least-squares form needs.)
  virtual void AddProduct(const LogMap& v, LogMap* out) const = 0;
};

}  // namespace ibrdf
