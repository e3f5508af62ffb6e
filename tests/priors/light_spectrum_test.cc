#include "ibrdf/solvers/priors/light_spectrum.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <tuple>

#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {
namespace {

// acos loses half the digits for texels that are opposite each other; rounding
// makes it 1.5e-8 or 0, and each texel has one such.
constexpr double kOpposite = 3e-8;
// Rounding of sums of up to 32 products of numbers below 1.
constexpr double kRounding = 1e-14;

// height, width, degrees of both parts
class LightSpectrumTest
    : public ::testing::TestWithParam<std::tuple<int, int, double>> {
 protected:
  const int height_ = std::get<0>(GetParam()), width_ = std::get<1>(GetParam());
  const double degrees_ = std::get<2>(GetParam());
  LightProcess Process() const {
    LightProcess process;
    process.smooth_degrees = process.rough_degrees = degrees_;
    return process;
  }
  const LightHyperparameters hyperparameters_{0.7, {-1.0, 0.5, 0.2, -2.0}};
  const ProcessSpectrum process_{height_, width_, Process()};
  const LightSpectrum spectrum_ = process_.At(hyperparameters_);
};

TEST_P(LightSpectrumTest, ProductIsThatOfTheDenseCorrelation) {
  const RowMatrix dense =
      LightCorrelation(height_, width_, Process(), hyperparameters_);
  RowMatrix product;
  spectrum_.Multiply(RowMatrix::Identity(dense.rows(), dense.rows()), &product);
  ASSERT_EQ(dense.rows(), product.rows());
  EXPECT_LT((product - dense).cwiseAbs().maxCoeff(), kOpposite);
  std::mt19937 rng(1);
  std::normal_distribution<double> g;
  for (const int rows : {1, 3, 7}) {
    RowMatrix X(rows, dense.rows());
    for (double& x : X.reshaped()) x = g(rng);
    spectrum_.Multiply(X, &product);
    ASSERT_EQ(rows, product.rows());
    ASSERT_EQ(dense.rows(), product.cols());
    EXPECT_LT((product - X * dense).cwiseAbs().maxCoeff(),
              kOpposite * X.cwiseAbs().maxCoeff());
  }
}

TEST_P(LightSpectrumTest, RoughPartIsWhatIsLeftWithoutTheOthers) {
  LightProcess process = Process();
  process.smooth_share = process.horizon_share = 0.0;
  const RowMatrix dense =
      LightCorrelation(height_, width_, process, hyperparameters_);
  RowMatrix product;
  process_.RoughAt(hyperparameters_)
      .Multiply(RowMatrix::Identity(dense.rows(), dense.rows()), &product);
  EXPECT_LT((product - dense).cwiseAbs().maxCoeff(), kOpposite);
}

TEST_P(LightSpectrumTest, BasisIsOrthonormalAndOrderedByFrequency) {
  const RowMatrix& F = spectrum_.basis();
  ASSERT_EQ(width_, F.rows());
  ASSERT_EQ(width_, F.cols());
  EXPECT_LT((F.transpose() * F - RowMatrix::Identity(width_, width_))
                .cwiseAbs()
                .maxCoeff(),
            kRounding);
  // For waves of frequency k, one column of the map apart:
  // f(c - 1) + f(c + 1) = 2 cos(2 pi k / width) f(c).
  for (int j = 0; j < width_; ++j) {
    const int k = LightSpectrum::FrequencyOf(j);
    ASSERT_LT(k, spectrum_.num_frequencies());
    for (int c = 0; c < width_; ++c) {
      EXPECT_NEAR(2 * std::cos(2 * std::acos(-1.0) * k / width_) * F(c, j),
                  F((c + 1) % width_, j) + F((c + width_ - 1) % width_, j),
                  kRounding);
    }
  }
}

TEST_P(LightSpectrumTest, BlocksAreSymmetricAndPositive) {
  for (int k = 0; k < spectrum_.num_frequencies(); ++k) {
    const RowMatrix& block = spectrum_.block(k);
    ASSERT_EQ(height_, block.rows());
    EXPECT_EQ(block, RowMatrix(block.transpose()));
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(block).eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), 0.0) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, LightSpectrumTest,
                         ::testing::Values(std::make_tuple(1, 8, 52.0),
                                           std::make_tuple(5, 2, 52.0),
                                           std::make_tuple(3, 6, 20.0),
                                           std::make_tuple(4, 8, 150.0),
                                           std::make_tuple(16, 32, 52.0)));

}  // namespace
}  // namespace ibrdf
