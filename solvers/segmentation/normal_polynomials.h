// What one material's log radiance is as a function of the normal, before its
// light is known: a polynomial.
#pragma once
#include <Eigen/Core>

namespace ibrdf {

inline constexpr int kMostPolynomialDegree = 3;

// Polynomials of unit normals [pixels][3] up to a degree, 1 to
// kMostPolynomialDegree, in columns: 4, 9 or 16 of them, which span the
// harmonics of those degrees.
Eigen::MatrixXd NormalPolynomials(const Eigen::MatrixX3d& normals, int degree);

// The inverses of the prior variances of their coefficients, which are over the
// variance of the noise.
Eigen::VectorXd PolynomialPrecisions(int degree);

}  // namespace ibrdf
