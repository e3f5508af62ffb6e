#include "ibrdf/solvers/optim/dense_algebra.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <random>

namespace ibrdf {
namespace {

// Sums of up to 40 products of numbers of size 1 to 4, in another order.
constexpr double kRounding = 1e-13;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

RowMatrix Random(int rows, int cols, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> g;
  RowMatrix out(rows, cols);
  for (double& v : out.reshaped()) v = g(rng);
  return out;
}

// Every entry by its definition.
RowMatrix SlowProduct(const RowMatrix& A, const RowMatrix& B) {
  RowMatrix C = RowMatrix::Zero(A.rows(), B.cols());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    for (Eigen::Index j = 0; j < B.cols(); ++j) {
      for (Eigen::Index k = 0; k < A.cols(); ++k) C(i, j) += A(i, k) * B(k, j);
    }
  }
  return C;
}

void ExpectNear(const RowMatrix& expected, const RowMatrix& actual) {
  ASSERT_EQ(expected.rows(), actual.rows());
  ASSERT_EQ(expected.cols(), actual.cols());
  EXPECT_LT((expected - actual).cwiseAbs().maxCoeff(), kRounding);
}

RowMatrix PositiveDefinite(int n) {
  const RowMatrix B = Random(n, n, 5);
  return SlowProduct(B, B.transpose()) / n + RowMatrix::Identity(n, n);
}

TEST(DenseAlgebra, ProductsInSinglePrecision) {
  // 40 products of numbers of size 1 to 4, each rounded to 6e-8 of itself.
  constexpr double kRoundingOfFloats = 4e-5;
  const FloatRowMatrix A = Random(100, 40, 1).cast<float>();
  const FloatRowMatrix B = Random(40, 7, 2).cast<float>();
  const RowMatrix expected = SlowProduct(A.cast<double>(), B.cast<double>());
  FloatRowMatrix C;
  MultiplyTransposed(A, FloatRowMatrix(B.transpose()), &C);
  EXPECT_LT((expected - C.cast<double>()).cwiseAbs().maxCoeff(),
            kRoundingOfFloats);
  for (const int threads : {1, 3}) {
    FloatRowMatrix tiled;
    MultiplyInTiles(A, B, threads, &tiled);
    EXPECT_LT((expected - tiled.cast<double>()).cwiseAbs().maxCoeff(),
              kRoundingOfFloats);
  }
}

TEST(DenseAlgebra, ProductsOverwriteWhatWasThere) {
  const int sizes[][3] = {
      {1, 1, 1}, {3, 5, 2}, {1, 40, 7}, {17, 1, 9}, {33, 8, 1}};
  for (const auto& [rows, inner, cols] : sizes) {
    const RowMatrix A = Random(rows, inner, 1), B = Random(inner, cols, 2);
    const RowMatrix expected = SlowProduct(A, B);
    RowMatrix C = RowMatrix::Constant(rows, cols, kNaN);
    Multiply(A, B, &C);
    ExpectNear(expected, C);
    C = RowMatrix::Constant(rows + 3, 2, kNaN);
    MultiplyTransposed(A, B.transpose(), &C);
    ExpectNear(expected, C);
  }
}

TEST(DenseAlgebra, BlocksOfLargerMatricesAreReadInPlace) {
  const RowMatrix A = Random(12, 15, 1), B = Random(14, 13, 2);
  const int shapes[][3] = {{5, 7, 6}, {1, 7, 6}, {5, 1, 6}, {5, 7, 1}};
  for (const auto& [rows, inner, cols] : shapes) {
    const auto a = A.block(2, 3, rows, inner);
    const auto b = B.block(1, 4, inner, cols);
    const auto b_transposed = B.block(1, 4, cols, inner);
    RowMatrix C;
    Multiply(a, b, &C);
    ExpectNear(SlowProduct(a, b), C);
    MultiplyTransposed(a, b_transposed, &C);
    ExpectNear(SlowProduct(a, b_transposed.transpose()), C);
  }
}

TEST(DenseAlgebra, VectorProductsAreThoseOfOneColumn) {
  const RowMatrix x = Random(60, 3, 3);
  const Eigen::VectorXd packed = x.col(1);
  const int sizes[][2] = {{1, 1}, {9, 4}, {4, 9}, {1, 40}, {40, 1}};
  for (const auto& [rows, cols] : sizes) {
    const RowMatrix A = Random(rows, cols, 4);
    const Eigen::VectorXd right = packed.segment(5, cols);
    const Eigen::VectorXd left = packed.segment(5, rows);
    ExpectNear(SlowProduct(A, right), MultiplyVector(A, right));
    ExpectNear(SlowProduct(A.transpose(), left),
               MultiplyTransposedVector(A, left));
    // A part of a vector, and a column of a row-major matrix.
    ExpectNear(SlowProduct(A, right),
               MultiplyVector(A, packed.segment(5, cols)));
    ExpectNear(SlowProduct(A, right),
               MultiplyVector(A, x.col(1).segment(5, cols)));
    ExpectNear(SlowProduct(A.transpose(), left),
               MultiplyTransposedVector(A, packed.segment(5, rows)));
  }
}

TEST(DenseAlgebra, FactorsSolveAndInvertByTheLowerTriangleAlone) {
  for (const int n : {1, 2, 7, 40}) {
    const RowMatrix A = PositiveDefinite(n);
    RowMatrix L = A;
    L.triangularView<Eigen::StrictlyUpper>().setConstant(kNaN);
    ASSERT_TRUE(Factorise(&L));
    const RowMatrix lower = L.triangularView<Eigen::Lower>().toDenseMatrix();
    ExpectNear(A, SlowProduct(lower, lower.transpose()));

    // A has its eigenvalues above 1: errors do not grow.
    const Eigen::VectorXd b = Random(n, 1, 6);
    Eigen::VectorXd x = b;
    SolveFactored(L, x.data());
    ExpectNear(b, SlowProduct(A, x));

    InvertFactored(&L);
    EXPECT_EQ(L, RowMatrix(L.transpose()));
    ExpectNear(RowMatrix::Identity(n, n), SlowProduct(A, L));
  }
}

TEST(DenseAlgebra, IndefiniteMatricesHaveNoFactor) {
  RowMatrix A = PositiveDefinite(5);
  A(3, 3) = -1.0;
  EXPECT_FALSE(Factorise(&A));
  RowMatrix zero = RowMatrix::Zero(2, 2);
  EXPECT_FALSE(Factorise(&zero));
}

}  // namespace
}  // namespace ibrdf
