// How probable an image is under a reflectance that is held, its light
// integrated out at a map's full size.
#pragma once
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// Random vectors for the determinant: it differs by the square root of 2 sum
// f^2 / probes, f half the logarithms that it sums, at most, but alike for
// reflectances that are compared.
inline constexpr int kProbesOfEvidence = 2;

struct MapEvidence {
  double cost = 0.0;   // -log evidence, nats
  double scale = 0.0;  // b of the likelihood at which it is highest
  // The multiple of the prior's deviations likewise.
  double prior_scale = 1.0;
  double misfit = 0.0;  // mean |log L_o - log I| under the map
};

// The evidence at an estimate's map by the Gaussian process, by Laplace's
// method:
//   cost = sum |r_i| / b + N log(2 b) + |z|^2 / (2 s^2)
//          + log det(1 + (s / b)^2 S^T J^T J S) / 2,
// r [N] the log residuals of its pixels, J those's derivatives by the map's
// log radiance, S z the map, z white. b and s are those of least cost, for
// the map as it is; 1 / b^2 is the information of a Laplacian. A reflectance
// that is sharper than the object pays by the determinant, one that is less
// sharp by the residuals. Costs of estimates on the same pixels and with maps
// of one size compare. The determinant is found by some hundred products
// (LanczosQuadrature). The setup is of an unknown light.
MapEvidence EvidenceOfMap(const SolveSetup& setup, const Estimate& estimate);

}  // namespace ibrdf
