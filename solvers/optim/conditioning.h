// How well a linear system of a few unknowns is conditioned.
#pragma once
#include <Eigen/Core>

#include "ibrdf/solvers/optim/conjugate_gradients.h"

namespace ibrdf {

// Ratio of the largest to the smallest eigenvalue of a symmetric matrix after
// scaling its diagonal to 1 (that of normal equations: the columns of the
// Jacobian to length 1), so that units do not matter; 1: the unknowns do not
// interact. Infinite where the matrix is singular to rounding; NaN where it is
// empty, not finite or a diagonal entry is not positive.
double ScaledCondition(const Eigen::MatrixXd& matrix);

// The conditioning of the preconditioned system that conjugate gradients were
// run on, at least: the ratio of the extreme eigenvalues of Lanczos'
// tridiagonal matrix, which are inside the system's and reach them as steps are
// made (Golub and Van Loan, Matrix Computations, 11.3). NaN without a step.
double LanczosCondition(const CgCoefficients& coefficients);

}  // namespace ibrdf
