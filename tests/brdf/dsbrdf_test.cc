#include "ibrdf/brdf/dsbrdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

TEST(SplineBasis, SumsToOneInterpolatesTheEndsAndIsExactOnLines) {
  for (const int n : {4, 6, 9}) {
    // Greville abscissae: a line's coefficients are its values there.
    const int spans = n - 3;
    std::vector<double> greville;
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      for (int k = 1; k <= 3; ++k) {
        sum += std::min(std::max(i + k - 3, 0), spans);
      }
      greville.push_back(sum / 3 / spans * kPi / 2);
    }
    for (int i = 0; i <= 100; ++i) {
      const double theta = i / 100.0 * kPi / 2;
      const SplineBasis basis(n, theta);
      double sum = 0.0, line = 0.0;
      for (int k = 0; k < 4; ++k) {
        EXPECT_GE(basis.weight[k], 0.0);
        sum += basis.weight[k];
        line += basis.weight[k] * greville[basis.first + k];
      }
      EXPECT_LE(basis.first + 4, n);
      EXPECT_NEAR(1.0, sum, 1e-14);
      EXPECT_NEAR(theta, line, 1e-14);
    }
    EXPECT_EQ(1.0, SplineBasis(n, 0.0).weight[0]);
    EXPECT_NEAR(1.0, SplineBasis(n, 2.0).weight[3], 1e-14);  // clamped
  }
}

Dsbrdf ConstantLobes() {
  Dsbrdf brdf;
  brdf.shape.lobes = 2;
  for (int c = 0; c < 3; ++c) {
    Eigen::VectorXd& p = brdf.parameters[c];
    p.resize(brdf.shape.num_parameters());
    for (int k = 0; k < brdf.shape.coefficients; ++k) {
      p[brdf.shape.LogKappa(0) + k] = std::log(0.2);
      p[brdf.shape.LogGamma(0) + k] = std::log(0.5);
      p[brdf.shape.LogKappa(1) + k] = std::log(3.0);
      p[brdf.shape.LogGamma(1) + k] = std::log(40.0 + c);
    }
    p[brdf.shape.LogUnit()] = std::log(0.5);
  }
  return brdf;
}

TEST(Dsbrdf, MatchesThePublishedFormula) {
  const Dsbrdf brdf = ConstantLobes();
  const Eigen::Array3d f = brdf.Evaluate(0.3, 1.1, 2.0);
  for (int c = 0; c < 3; ++c) {
    const double expected =
        0.5 * (std::exp(0.2 * std::pow(std::cos(0.3), 0.5)) - 1 +
               std::exp(3.0 * std::pow(std::cos(0.3), 40.0 + c)) - 1);
    EXPECT_NEAR(expected, f[c], 1e-13);
  }
  // The exchange of the directions adds pi to phi_d.
  EXPECT_TRUE((f == brdf.Function()(0.3, 1.1, 2.0 + kPi)).all());
}

TEST(Dsbrdf, IsFiniteWithExtremeParameters) {
  const DsbrdfShape shape;
  for (const double value : {-1e3, 0.0, 20.0, 1e3}) {
    const std::vector<double> p(shape.num_parameters(), value);
    for (const double h : {0.0, 1e-9, 0.7, kPi / 2}) {
      for (const double d : {0.0, 0.7, kPi / 2}) {
        std::vector<double> gradient(p.size());
        const double f = EvaluateDsbrdf(
            shape, p.data(), DsbrdfGeometry(shape, h, d), gradient.data());
        EXPECT_TRUE(std::isfinite(f)) << value << " " << h << " " << d;
        EXPECT_GE(f, 0.0);
        for (const double g : gradient) EXPECT_TRUE(std::isfinite(g));
      }
    }
  }
}

TEST(Dsbrdf, GradientMatchesDifferences) {
  DsbrdfShape shape;
  shape.coefficients = 5;
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> angle(0.0, 1.57), kappa(-6.0, 2.0),
      gamma(-3.0, 5.0);
  for (int i = 0; i < 40; ++i) {
    std::vector<double> p(shape.num_parameters());
    for (int r = 0; r < shape.lobes; ++r) {
      for (int k = 0; k < shape.coefficients; ++k) {
        p[shape.LogKappa(r) + k] = kappa(rng);
        p[shape.LogGamma(r) + k] = gamma(rng);
      }
    }
    p[shape.LogUnit()] = kappa(rng);
    const DsbrdfGeometry geometry(shape, angle(rng), angle(rng));
    std::vector<double> gradient(p.size());
    const double f = EvaluateDsbrdf(shape, p.data(), geometry, gradient.data());
    for (size_t k = 0; k < p.size(); ++k) {
      constexpr double kStep = 1e-5;
      std::vector<double> up = p, down = p;
      up[k] += kStep;
      down[k] -= kStep;
      const double difference =
          (EvaluateDsbrdf(shape, up.data(), geometry, nullptr) -
           EvaluateDsbrdf(shape, down.data(), geometry, nullptr)) /
          (2 * kStep);
      // Second order in the step, with third derivatives up to 1e3 f.
      EXPECT_NEAR(difference, gradient[k], 1e-7 * f) << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace ibrdf
