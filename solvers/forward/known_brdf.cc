#include "ibrdf/solvers/forward/known_brdf.h"

namespace ibrdf {

BrdfGrid KnownBrdf::Grid() const {
  return function ? BrdfGrid::FromFunction(function, {})
                  : BrdfGrid::FromMerl(table, {});
}

BrdfFunction KnownBrdf::Lookup() const {
  if (function) return function;
  return [this](double theta_h, double theta_d, double phi_d) {
    return InterpolateMerl(table, theta_h, theta_d, phi_d);
  };
}

}  // namespace ibrdf
