// Dense products and Cholesky factors by BLAS and LAPACK, one thread each, so
// that the bits do not depend on a machine's number of threads.
#pragma once
#include <Eigen/Core>

namespace ibrdf {

using RowMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// C = A B and C = A B^T; C is resized.
void Multiply(const RowMatrix& A, const RowMatrix& B, RowMatrix* C);
void MultiplyTransposed(const RowMatrix& A, const RowMatrix& B, RowMatrix* C);

// Lower Cholesky factor in place of a symmetric matrix's lower triangle. False
// where it is not positive definite.
bool Factorise(RowMatrix* A);
// x := (L L^T)^-1 x.
void SolveFactored(const RowMatrix& L, double* x);
// The whole symmetric (L L^T)^-1 in place of L.
void InvertFactored(RowMatrix* L);

}  // namespace ibrdf
