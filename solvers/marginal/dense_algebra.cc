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
}

namespace ibrdf {
namespace {

void OneThread() {
  static std::once_flag once;
  std::call_once(once, [] { openblas_set_num_threads(1); });
}

}  // namespace

void Multiply(const Eigen::Ref<const RowMatrix>& A,
              const Eigen::Ref<const RowMatrix>& B, RowMatrix* C) {
  CHECK_EQ(A.cols(), B.rows());
  OneThread();
  C->resize(A.rows(), B.cols());
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans,
              static_cast<int>(A.rows()), static_cast<int>(B.cols()),
              static_cast<int>(A.cols()), 1.0, A.data(),
              static_cast<int>(A.outerStride()), B.data(),
              static_cast<int>(B.outerStride()), 0.0, C->data(),
              static_cast<int>(C->cols()));
}

void MultiplyTransposed(const Eigen::Ref<const RowMatrix>& A,
                        const Eigen::Ref<const RowMatrix>& B, RowMatrix* C) {
  CHECK_EQ(A.cols(), B.cols());
  OneThread();
  C->resize(A.rows(), B.rows());
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans,
              static_cast<int>(A.rows()), static_cast<int>(B.rows()),
              static_cast<int>(A.cols()), 1.0, A.data(),
              static_cast<int>(A.outerStride()), B.data(),
              static_cast<int>(B.outerStride()), 0.0, C->data(),
              static_cast<int>(C->cols()));
}

Eigen::VectorXd MultiplyVector(const RowMatrix& A,
                               const Eigen::Ref<const Eigen::VectorXd>& x) {
  CHECK_EQ(A.cols(), x.size());
  OneThread();
  Eigen::VectorXd out(A.rows());
  cblas_dgemv(CblasRowMajor, CblasNoTrans, static_cast<int>(A.rows()),
              static_cast<int>(A.cols()), 1.0, A.data(),
              static_cast<int>(A.cols()), x.data(), 1, 0.0, out.data(), 1);
  return out;
}

Eigen::VectorXd MultiplyTransposedVector(
    const RowMatrix& A, const Eigen::Ref<const Eigen::VectorXd>& x) {
  CHECK_EQ(A.rows(), x.size());
  OneThread();
  Eigen::VectorXd out(A.cols());
  cblas_dgemv(CblasRowMajor, CblasTrans, static_cast<int>(A.rows()),
              static_cast<int>(A.cols()), 1.0, A.data(),
              static_cast<int>(A.cols()), x.data(), 1, 0.0, out.data(), 1);
  return out;
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
