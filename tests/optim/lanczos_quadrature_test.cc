#include "ibrdf/solvers/optim/lanczos_quadrature.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <vector>

namespace ibrdf {
namespace {

double Trace(const std::vector<SpectralNode>& nodes, double (*f)(double)) {
  double sum = 0.0;
  for (const SpectralNode& node : nodes) {
    sum += node.weight * f(node.eigenvalue);
  }
  return sum;
}
double One(double) { return 1.0; }
double Log(double v) { return std::log(v); }
double Log1p(double v) { return std::log1p(std::max(v, 0.0)); }

std::vector<SpectralNode> OfMatrix(const Eigen::MatrixXd& a, int probes,
                                   int steps, uint64_t seed = 1) {
  return LanczosQuadrature(
      [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return a * v; },
      a.rows(), probes, steps, seed);
}

Eigen::MatrixXd RandomMatrix(int rows, int columns) {
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < columns; ++k) m(i, k) = normal(rng);
  }
  return m;
}

TEST(LanczosQuadrature, AMultipleOfOneIsExactAfterOneStep) {
  const std::vector<SpectralNode> nodes =
      OfMatrix(2.5 * Eigen::MatrixXd::Identity(30, 30), 3, 20);
  ASSERT_EQ(3u, nodes.size());
  EXPECT_NEAR(30.0 * std::log(2.5), Trace(nodes, Log), 1e-12);
}

TEST(LanczosQuadrature, FewDistinctEigenvaluesOfADiagonalAreExact) {
  Eigen::VectorXd diagonal(60);
  for (int i = 0; i < 60; ++i) diagonal[i] = std::pow(10.0, i % 5 - 2);
  const Eigen::MatrixXd matrix = diagonal.asDiagonal();
  const std::vector<SpectralNode> nodes = OfMatrix(matrix, 1, 40);
  EXPECT_NEAR(60.0, Trace(nodes, One), 1e-9);
  EXPECT_NEAR(diagonal.array().log().sum(), Trace(nodes, Log), 1e-6);
}

// As that of a light: many eigenvalues of 0, few of a million.
TEST(LanczosQuadrature, LogDeterminantOfAWideSpectrumIsNearItsOwn) {
  constexpr int kSize = 300;
  Eigen::MatrixXd j = RandomMatrix(90, kSize);
  for (int i = 0; i < 90; ++i) j.row(i) *= std::pow(10.0, 2.0 - 0.05 * i);
  const Eigen::MatrixXd information = j.transpose() * j;
  const Eigen::MatrixXd one_and =
      Eigen::MatrixXd::Identity(kSize, kSize) + information;
  const Eigen::MatrixXd factor = one_and.llt().matrixL();
  const double exact = 2.0 * factor.diagonal().array().log().sum();
  const double found = Trace(OfMatrix(information, 64, 100), Log1p);
  EXPECT_NEAR(1.0, found / exact, 0.05);
  EXPECT_NEAR(kSize, Trace(OfMatrix(information, 4, 100), One), 1e-8);
}

TEST(LanczosQuadrature, SameSeedSameBitsAndEmptyMatrixNothing) {
  const Eigen::MatrixXd j = RandomMatrix(8, 12);
  const Eigen::MatrixXd a = j.transpose() * j;
  EXPECT_EQ(Trace(OfMatrix(a, 2, 12, 5), Log1p),
            Trace(OfMatrix(a, 2, 12, 5), Log1p));
  EXPECT_NE(Trace(OfMatrix(a, 1, 5, 5), Log1p),
            Trace(OfMatrix(a, 1, 5, 6), Log1p));
  EXPECT_TRUE(OfMatrix(Eigen::MatrixXd(0, 0), 2, 12).empty());
}

}  // namespace
}  // namespace ibrdf
