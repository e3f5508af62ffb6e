#include "ibrdf/solvers/optim/dense_algebra.h"

#include <cblas.h>
#include <glog/logging.h>

#include <algorithm>
#include <mutex>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/solvers/optim/blas_kernels.h"

// LAPACK, column-major.
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda,
             int* info);
void dpotri_(const char* uplo, const int* n, double* a, const int* lda,
             int* info);
}

namespace ibrdf {
namespace {

// Rows of one task of a product.
constexpr Eigen::Index kTileRows = 48;

// Before main, where nothing else runs yet; Ceres's products gain as well.
[[maybe_unused]] const bool blas_core_taken = TakeFittingBlasCore();

void OneThread() {
  static std::once_flag once;
  std::call_once(once, [] { openblas_set_num_threads(1); });
}

// BLAS's product by the type of its numbers.
constexpr auto& Product(double) { return cblas_dgemm; }
constexpr auto& Product(float) { return cblas_sgemm; }

// C = A op(B), [rows of A][columns].
template <typename Matrix>
void Gemm(const Eigen::Ref<const Matrix>& A, const Eigen::Ref<const Matrix>& B,
          CBLAS_TRANSPOSE op, Eigen::Index columns, Matrix* C) {
  using Number = typename Matrix::Scalar;
  OneThread();
  C->resize(A.rows(), columns);
  Product(Number())(CblasRowMajor, CblasNoTrans, op, static_cast<int>(A.rows()),
                    static_cast<int>(columns), static_cast<int>(A.cols()),
                    Number(1), A.data(), static_cast<int>(A.outerStride()),
                    B.data(), static_cast<int>(B.outerStride()), Number(0),
                    C->data(), static_cast<int>(columns));
}

template <typename Matrix>
void GemmInTiles(const Eigen::Ref<const Matrix>& A, const Matrix& B,
                 int num_threads, Matrix* C) {
  CHECK_EQ(A.cols(), B.rows());
  C->resize(A.rows(), B.cols());
  const Eigen::Index tiles = (A.rows() + kTileRows - 1) / kTileRows;
  ParallelFor(tiles, num_threads, [&](int64_t tile, int) {
    const Eigen::Index begin = tile * kTileRows;
    const Eigen::Index rows = std::min(kTileRows, A.rows() - begin);
    Matrix out;
    Gemm<Matrix>(A.middleRows(begin, rows), B, CblasNoTrans, B.cols(), &out);
    C->middleRows(begin, rows) = out;
  });
}

// op(A) x, [rows].
Eigen::VectorXd Gemv(const RowMatrix& A, CBLAS_TRANSPOSE op,
                     const Eigen::Ref<const Eigen::VectorXd>& x,
                     Eigen::Index rows) {
  OneThread();
  Eigen::VectorXd out(rows);
  cblas_dgemv(CblasRowMajor, op, static_cast<int>(A.rows()),
              static_cast<int>(A.cols()), 1.0, A.data(),
              static_cast<int>(A.cols()), x.data(), 1, 0.0, out.data(), 1);
  return out;
}

}  // namespace

void Multiply(const Eigen::Ref<const RowMatrix>& A,
              const Eigen::Ref<const RowMatrix>& B, RowMatrix* C) {
  CHECK_EQ(A.cols(), B.rows());
  Gemm<RowMatrix>(A, B, CblasNoTrans, B.cols(), C);
}

void MultiplyTransposed(const Eigen::Ref<const RowMatrix>& A,
                        const Eigen::Ref<const RowMatrix>& B, RowMatrix* C) {
  CHECK_EQ(A.cols(), B.cols());
  Gemm<RowMatrix>(A, B, CblasTrans, B.rows(), C);
}

void MultiplyTransposed(const Eigen::Ref<const FloatRowMatrix>& A,
                        const Eigen::Ref<const FloatRowMatrix>& B,
                        FloatRowMatrix* C) {
  CHECK_EQ(A.cols(), B.cols());
  Gemm<FloatRowMatrix>(A, B, CblasTrans, B.rows(), C);
}

void MultiplyInTiles(const Eigen::Ref<const RowMatrix>& A, const RowMatrix& B,
                     int num_threads, RowMatrix* C) {
  GemmInTiles<RowMatrix>(A, B, num_threads, C);
}

void MultiplyInTiles(const Eigen::Ref<const FloatRowMatrix>& A,
                     const FloatRowMatrix& B, int num_threads,
                     FloatRowMatrix* C) {
  GemmInTiles<FloatRowMatrix>(A, B, num_threads, C);
}

Eigen::VectorXd MultiplyVector(const RowMatrix& A,
                               const Eigen::Ref<const Eigen::VectorXd>& x) {
  CHECK_EQ(A.cols(), x.size());
  return Gemv(A, CblasNoTrans, x, A.rows());
}

Eigen::VectorXd MultiplyTransposedVector(
    const RowMatrix& A, const Eigen::Ref<const Eigen::VectorXd>& x) {
  CHECK_EQ(A.rows(), x.size());
  return Gemv(A, CblasTrans, x, A.cols());
}

// A row-major lower triangle is a column-major upper one.
bool Factorise(RowMatrix* A) {
  OneThread();
  const int n = static_cast<int>(A->rows());
  int info = 0;
  dpotrf_("U", &n, A->data(), &n, &info);
  return info == 0;
}

void SolveFactored(const RowMatrix& L, double* x) {
  OneThread();
  const int n = static_cast<int>(L.rows());
  cblas_dtrsv(CblasRowMajor, CblasLower, CblasNoTrans, CblasNonUnit, n,
              L.data(), n, x, 1);
  cblas_dtrsv(CblasRowMajor, CblasLower, CblasTrans, CblasNonUnit, n, L.data(),
              n, x, 1);
}

void InvertFactored(RowMatrix* L) {
  const int n = static_cast<int>(L->rows());
  int info = 0;
  dpotri_("U", &n, L->data(), &n, &info);
  CHECK_EQ(info, 0);
  L->triangularView<Eigen::StrictlyUpper>() = L->transpose();
}

}  // namespace ibrdf
