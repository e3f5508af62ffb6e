// Preconditioned conjugate gradients on functions.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace ibrdf {

// Lengths of the steps, and of the last directions in the next: what the
// condition of the system is estimated from (LanczosCondition).
struct CgCoefficients {
  std::vector<double> alpha, beta;
};

// Approximates A^-1 b from zero: `product`(v) = A v, `precondition`(r) an
// approximate A^-1 r, both symmetric positive definite. Stops after
// max_iterations, where r . precondition(r) has fallen to `forcing` times its
// first value, or at a direction that A does not curve upwards along.
// Appends to `coefficients`, which may be null.
template <typename Product, typename Precondition>
Eigen::VectorXd ConjugateGradients(const Product& product,
                                   const Precondition& precondition,
                                   const Eigen::VectorXd& b, int max_iterations,
                                   double forcing,
                                   CgCoefficients* coefficients = nullptr) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  Eigen::VectorXd r = b, z = precondition(r), p = z;
  double rz = r.dot(z);
  const double stop = rz * forcing;
  for (int k = 0; k < max_iterations && rz > stop; ++k) {
    const Eigen::VectorXd Ap = product(p);
    const double curvature = p.dot(Ap);
    if (!(curvature > 0.0)) break;
    const double alpha = rz / curvature;
    x += alpha * p;
    r -= alpha * Ap;
    z = precondition(r);
    const double next = r.dot(z);
    const double beta = next / rz;
    if (coefficients != nullptr) {
      coefficients->alpha.push_back(alpha);
      coefficients->beta.push_back(beta);
    }
    p = z + beta * p;
    rz = next;
  }
  return x;
}

}  // namespace ibrdf
