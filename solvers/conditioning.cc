#include "solvers/conditioning.h"

#include <Eigen/Dense>
#include <limits>

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

}  // namespace ibrdf
