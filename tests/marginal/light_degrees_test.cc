#include "ibrdf/solvers/marginal/light_degrees.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/marginal/small_light.h"

namespace ibrdf {
namespace {

constexpr double kSolved = 1e-8;

struct Seen {
  std::array<RowMatrix, 3> matrices;
  MarginalLikelihood likelihood;
  DataErrors errors;
  LightMode mode;
};

Seen See(double width, double sigma, int directional_lights = 0) {
  const std::array<RowMatrix, 3> T = Lobes(width, kPoints, directional_lights);
  Seen out{T,
           Likelihood(
               {LogRadiance(T, DrawLight(Proper(), 1.0, 3, directional_lights)),
                {},
                {}},
               Proper(), directional_lights),
           Noise(sigma),
           {}};
  out.likelihood.Evaluate(T, out.errors, {}, 1e-6, &out.mode, nullptr);
  return out;
}

MarginalLikelihood::FunctionVariance VarianceOf(const Seen& seen,
                                                const RowMatrix& functions) {
  return seen.likelihood.LightFunctionVariance(seen.matrices, seen.errors, {},
                                               seen.mode, functions);
}

TEST(LightFunctionVariance, OfTexelsIsTheDiagonal) {
  for (const int directional_lights : {0, 2}) {
    const Seen seen = See(0.5, 0.05, directional_lights);
    const auto texels = VarianceOf(seen, RowMatrix::Identity(kTexels, kTexels));
    const Eigen::VectorXd prior = seen.likelihood.PriorLightVariance({});
    const Eigen::VectorXd posterior = seen.likelihood.LightVariance(
        seen.matrices, seen.errors, {}, seen.mode);
    for (int t = 0; t < kTexels; ++t) {
      double before = 0.0, left = 0.0;
      for (int c = 0; c < 3; ++c) {
        before += prior[c * kTexels + t];
        left += posterior[c * kTexels + t];
      }
      EXPECT_NEAR(before, texels.prior[t], kSolved * before);
      EXPECT_NEAR(left, texels.posterior[t], kSolved * before);
    }
  }
}

// The variance of a harmonic over samples of the prior.
TEST(LightFunctionVariance, OfHarmonicsIsThatOfSamples) {
  constexpr int kSamples = 3000;
  const RowMatrix Y = HarmonicsOfTexels(2, kHeight, kWidth);
  const Seen seen = See(0.5, 0.05);
  const auto expected = VarianceOf(seen, Y);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(Y.cols());
  for (int k = 0; k < kSamples; ++k) {
    const Eigen::VectorXd l = DrawLight(Proper(), 1.0, 100 + k);
    for (int c = 0; c < 3; ++c) {
      squares += (Y.transpose() * l.segment(c * kTexels, kTexels))
                     .array()
                     .square()
                     .matrix();
    }
  }
  squares /= kSamples;
  for (Eigen::Index i = 0; i < Y.cols(); ++i) {
    // The variance of 3000 squares of three channels that go together.
    EXPECT_NEAR(1.0, squares[i] / expected.prior[i], 0.12) << i;
  }
}

// The covariance of all texels, by polarisation, and samples of it.
TEST(LightFunctionVariance, OfThePosteriorIsThatOfSamples) {
  const Seen seen = See(0.5, 0.05);
  RowMatrix pairs = RowMatrix::Zero(kTexels, kTexels * kTexels);
  for (int i = 0; i < kTexels; ++i) {
    for (int j = 0; j < kTexels; ++j) {
      pairs(i, i * kTexels + j) += 1.0;
      pairs(j, i * kTexels + j) += 1.0;
    }
  }
  const Eigen::VectorXd sums = VarianceOf(seen, pairs).posterior;
  const Eigen::VectorXd texels =
      VarianceOf(seen, RowMatrix::Identity(kTexels, kTexels)).posterior;
  Eigen::MatrixXd covariance(kTexels, kTexels);
  for (int i = 0; i < kTexels; ++i) {
    for (int j = 0; j < kTexels; ++j) {
      covariance(i, j) = 0.5 * (sums[i * kTexels + j] - texels[i] - texels[j]);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-8);
  const Eigen::MatrixXd root =
      solver.eigenvectors() *
      solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const RowMatrix Y = HarmonicsOfTexels(2, kHeight, kWidth);
  const Eigen::VectorXd expected = VarianceOf(seen, Y).posterior;
  std::mt19937_64 rng(5);
  std::normal_distribution<double> gauss;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(Y.cols());
  constexpr int kSamples = 4000;
  for (int k = 0; k < kSamples; ++k) {
    Eigen::VectorXd z(kTexels);
    for (double& x : z) x = gauss(rng);
    squares += (Y.transpose() * (root * z)).array().square().matrix();
  }
  squares /= kSamples;
  for (Eigen::Index i = 0; i < Y.cols(); ++i) {
    EXPECT_NEAR(1.0, squares[i] / expected[i], 0.12) << i;
  }
}

std::vector<double> Left(const Seen& seen) {
  return VarianceLeftByDegree(seen.likelihood, seen.matrices, seen.errors, {},
                              seen.mode, kHeight, kWidth);
}

TEST(VarianceLeftByDegree, IsOneWhereNothingIsTold) {
  for (const double left : Left(See(0.5, 1e4))) EXPECT_NEAR(1.0, left, 1e-5);
}

TEST(VarianceLeftByDegree, WideLobesTellLowDegreesAlone) {
  const std::vector<double> wide = Left(See(1.5, 0.02));
  ASSERT_EQ(3u, wide.size());  // half of four rows
  EXPECT_LT(wide[0], 0.1);
  EXPECT_LT(wide[0], wide[1]);
  EXPECT_LT(wide[1], wide[2]);
  EXPECT_GT(wide[2], 0.5);
  // More noise leaves more.
  const std::vector<double> noisy = Left(See(1.5, 0.3));
  for (size_t l = 0; l < 3; ++l) EXPECT_GT(noisy[l], wide[l]);
}

}  // namespace
}  // namespace ibrdf
