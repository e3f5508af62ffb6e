// Functions of the eigenvalues of a symmetric matrix that is known by its
// products alone.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace ibrdf {

// trace f(A) is near sum_i weight_i f(eigenvalue_i).
struct SpectralNode {
  double eigenvalue = 0.0, weight = 0.0;
};

// Stochastic Lanczos quadrature (Ubaru, Chen and Saad 2017): `probes` random
// vectors of signs, at most `steps` products with each, whose bases are kept
// orthogonal. The weights' sum is `size`. Exact for a multiple of the unit
// matrix, and with one probe for any diagonal matrix of at most `steps`
// distinct eigenvalues. product: v to A v, both [size].
std::vector<SpectralNode> LanczosQuadrature(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& product,
    Eigen::Index size, int probes, int steps, uint64_t seed);

}  // namespace ibrdf
