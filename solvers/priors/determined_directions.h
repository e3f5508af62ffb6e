// What an image adds to what the prior knows of a reflectance.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// A direction of codes and colours is determined where less than this share of
// the prior's variance is left.
inline constexpr double kDetermined = 0.1;

struct DeterminedDirections {
  // The share that is left of the prior's variance along each direction,
  // ascending, in [0, 1]: the eigenvalues of the posterior's covariance where
  // the prior's is 1. Both are diagonal in these directions.
  std::vector<double> variance_left;

  int num_determined() const;
  // Sum of what is not left: the degrees of freedom for signal (Rodgers,
  // Inverse Methods for Atmospheric Sounding, 2000, Eq. 2.80).
  double degrees_of_freedom() const;
  // What the posterior knows beyond the prior, nats: -1/2 sum log left.
  double information() const;
};

// covariance: the posterior's [n * n]. Unset where sizes differ or a value is
// not finite.
std::optional<DeterminedDirections> FindDeterminedDirections(
    const MaterialPrior& prior, const std::vector<double>& covariance);

}  // namespace ibrdf
