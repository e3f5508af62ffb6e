#include "solvers/marginal/dense_algebra.h"

#include <cblas.h>
#include <glog/logging.h>

#include <mutex>

// LAPACK, column-major.
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda,
             int* info);
void dpotri_(const char* uplo, const int* n, double* a, const int* lda,
             int* info);
void dpotrs_(const char* uplo, const int* n, const int* nrhs, const double* a,
             const int* lda, double* b, const int* ldb, int* info);
}

namespace ibrdf {
namespace {

void OneThread() {
  static std::once_flag once;
  std::call_once(once, [] { openblas_set_num_threads(1); });
}

}  // namespace

void Multiply(const RowMatrix& A, const RowMatrix& B, RowMatrix* C) {
  CHECK_EQ(A.cols(), B.rows());
  OneThread();
  C->resize(A.rows(), B.cols());
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans,
              static_cast<int>(A.rows()), static_cast<int>(B.cols()),
              static_cast<int>(A.cols()), 1.0, A.data(),
              static_cast<int>(A.cols()), B.data(), static_cast<int>(B.cols()),
              0.0, C->data(), static_cast<int>(C->cols()));
}

void MultiplyTransposed(const RowMatrix& A, const RowMatrix& B, RowMatrix* C) {
  CHECK_EQ(A.cols(), B.cols());
  OneThread();
  C->resize(A.rows(), B.rows());
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans,
              static_cast<int>(A.rows()), static_cast<int>(B.rows()),
              static_cast<int>(A.cols()), 1.0, A.data(),
              static_cast<int>(A.cols()), B.data(), static_cast<int>(B.cols()),
              0.0, C->data(), static_cast<int>(C->cols()));
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
  const int n = static_cast<int>(L.rows()), one = 1;
  int info = 0;
  dpotrs_("U", &n, &one, L.data(), &n, x, &n, &info);
  CHECK_EQ(info, 0);
}

void InvertFactored(RowMatrix* L) {
  const int n = static_cast<int>(L->rows());
  int info = 0;
  dpotri_("U", &n, L->data(), &n, &info);
  CHECK_EQ(info, 0);
  L->triangularView<Eigen::StrictlyUpper>() = L->transpose();
}

}  // namespace ibrdf
