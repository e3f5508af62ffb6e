#include "ibrdf/solvers/optim/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace ibrdf {
namespace {

constexpr int kSize = 40;

// A system whose preconditioned eigenvalues span six orders of magnitude.
struct System {
  System() : A(kSize, kSize), b(kSize), metric(kSize) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    Eigen::MatrixXd mix(kSize, kSize);
    for (double& m : mix.reshaped()) m = normal(random);
    for (int i = 0; i < kSize; ++i) {
      metric[i] = std::exp(normal(random));
      b[i] = normal(random);
      mix.row(i) *= std::pow(10.0, -3.0 * i / kSize);
    }
    A = mix.transpose() * mix;
    A.diagonal() += 1e-6 * metric;
  }
  Eigen::VectorXd Solve(int iterations, double forcing,
                        CgCoefficients* coefficients = nullptr) const {
    return ConjugateGradients(
        [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return A * v; },
        [&](const Eigen::VectorXd& r) -> Eigen::VectorXd {
          return r.cwiseQuotient(metric);
        },
        b, iterations, forcing, coefficients);
  }
  double SquaredResidual(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd r = b - A * x;
    return r.dot(r.cwiseQuotient(metric));
  }

  Eigen::MatrixXd A;
  Eigen::VectorXd b, metric;
};

TEST(ConjugateGradients, StopAtTheirShareOfTheSquaredResidualAndNotBefore) {
  const System system;
  const double first = system.SquaredResidual(Eigen::VectorXd::Zero(kSize));
  size_t before = 0;
  for (const double forcing : {1e-1, 1e-2, 1e-4, 1e-8}) {
    SCOPED_TRACE(forcing);
    CgCoefficients steps;
    const Eigen::VectorXd x = system.Solve(1000, forcing, &steps);
    const int taken = static_cast<int>(steps.alpha.size());
    EXPECT_LE(system.SquaredResidual(x), 1.001 * forcing * first);
    EXPECT_GT(system.SquaredResidual(system.Solve(taken - 1, 0.0)),
              0.999 * forcing * first);
    EXPECT_GT(steps.alpha.size(), before);
    before = steps.alpha.size();
  }
}

TEST(ConjugateGradients, OfFineForcingAreTheDenseSolution) {
  const System system;
  const Eigen::VectorXd exact = system.A.llt().solve(system.b);
  EXPECT_LT((system.Solve(2000, 1e-24) - exact).norm(), 1e-5 * exact.norm());
}

TEST(ConjugateGradients, EndBeforeADirectionOfNoCurvature) {
  System system;
  system.A = Eigen::MatrixXd::Zero(kSize, kSize);
  EXPECT_EQ(0.0, system.Solve(10, 0.0).norm());
  system.A = -Eigen::MatrixXd::Identity(kSize, kSize);
  EXPECT_EQ(0.0, system.Solve(10, 0.0).norm());
}

}  // namespace
}  // namespace ibrdf
