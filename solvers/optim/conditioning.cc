#include "ibrdf/solvers/optim/conditioning.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

namespace ibrdf {

double ScaledCondition(const Eigen::MatrixXd& matrix) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (matrix.size() == 0 || !matrix.allFinite()) return nan;
  const Eigen::VectorXd diagonal = matrix.diagonal();
  if (!(diagonal.minCoeff() > 0.0)) return nan;
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      scaled, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().maxCoeff();
  const double smallest = solver.eigenvalues().minCoeff();
  // Eigenvalues are good to a rounding of the largest.
  const double rounding = std::numeric_limits<double>::epsilon() * largest *
                          static_cast<double>(matrix.rows());
  if (smallest <= rounding) return std::numeric_limits<double>::infinity();
  return largest / smallest;
}

double LanczosCondition(const CgCoefficients& coefficients) {
  const std::vector<double>& alpha = coefficients.alpha;
  const std::vector<double>& beta = coefficients.beta;
  const auto n = static_cast<Eigen::Index>(alpha.size());
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd diagonal(n), beside(n - 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    diagonal[k] = 1.0 / alpha[k];
    if (k > 0) diagonal[k] += beta[k - 1] / alpha[k - 1];
    if (k + 1 < n) beside[k] = std::sqrt(beta[k]) / alpha[k];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff() / solver.eigenvalues().minCoeff();
}

}  // namespace ibrdf
