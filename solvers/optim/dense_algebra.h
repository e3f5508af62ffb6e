// Dense products and Cholesky factors by BLAS and LAPACK, one thread each, so
// that the bits do not depend on a machine's number of threads.
#pragma once
#include <Eigen/Core>

namespace ibrdf {

using RowMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
// Of single precision: half the time where seven digits do.
using FloatRowMatrix =
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// C = A B and C = A B^T; C is resized.
void Multiply(const Eigen::Ref<const RowMatrix>& A,
              const Eigen::Ref<const RowMatrix>& B, RowMatrix* C);
void MultiplyTransposed(const Eigen::Ref<const RowMatrix>& A,
                        const Eigen::Ref<const RowMatrix>& B, RowMatrix* C);
void MultiplyTransposed(const Eigen::Ref<const FloatRowMatrix>& A,
                        const Eigen::Ref<const FloatRowMatrix>& B,
                        FloatRowMatrix* C);
// The first by tiles of rows in threads; the same bits for any number of them.
void MultiplyInTiles(const Eigen::Ref<const RowMatrix>& A, const RowMatrix& B,
                     int num_threads, RowMatrix* C);
void MultiplyInTiles(const Eigen::Ref<const FloatRowMatrix>& A,
                     const FloatRowMatrix& B, int num_threads,
                     FloatRowMatrix* C);

// A x and A^T x.
Eigen::VectorXd MultiplyVector(const RowMatrix& A,
                               const Eigen::Ref<const Eigen::VectorXd>& x);
Eigen::VectorXd MultiplyTransposedVector(
    const RowMatrix& A, const Eigen::Ref<const Eigen::VectorXd>& x);

// Lower Cholesky factor in place of a symmetric matrix's lower triangle. False
// where it is not positive definite.
bool Factorise(RowMatrix* A);
// x := (L L^T)^-1 x.
void SolveFactored(const RowMatrix& L, double* x);
// The whole symmetric (L L^T)^-1 in place of L.
void InvertFactored(RowMatrix* L);

}  // namespace ibrdf
