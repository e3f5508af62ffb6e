// The likelihood of radiance of which intervals are known.
#include "ibrdf/solvers/costs/log_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/non_finite.h"

namespace ibrdf {
namespace {

// A point of three channels: a code, a clipped one and a black one.
Observations OnePoint() {
  return MakeObservations({1.0, 2.0, 0.1}, {0.9, 2.0, 0.0},
                          {1.1, kInfinity, 0.1});
}

TEST(IntervalObservations, TakePartWithOneEnd) {
  const Observations o = MakeObservations(
      {1, 1, 1, 1, 1, 1, 1, 1, std::nan("")}, {1, 0.5, 0, 1, 1, 0, 1, 1, 0},
      {1, kInfinity, 2, 1, 1, kInfinity, 1, 1, 1});
  EXPECT_EQ((std::vector<char>{1, 0, 0}), o.valid);
  EXPECT_EQ(1, o.num_valid);
  const Observations second = SelectObservations(o, {1, 0});
  EXPECT_EQ((std::vector<char>{0, 1}), second.valid);
  EXPECT_EQ(0.5, second.Interval(4).low);
}

TEST(IntervalObservations, CostNothingWhereTheyHold) {
  LikelihoodDerivatives d;
  const LikelihoodValue value =
      EvaluateLikelihood({1.05, 700.0, 0.0}, OnePoint(), {}, &d);
  EXPECT_EQ(0.0, value.cost);
  EXPECT_EQ(0.0, value.misfit);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(0.0, d.residual[c]);
    EXPECT_EQ(0.0, d.d_residual[c]);
    EXPECT_EQ(0.0, d.weight[c]);
  }
}

// The misfit counts the code, which holds, and the clipped value, which does
// not; the black one says nothing.
TEST(IntervalObservations, CostTheDistanceFromTheNearestEnd) {
  const RobustLogLikelihood likelihood{0.05, 1e-6, 0.5};
  LikelihoodDerivatives d;
  const LikelihoodValue value =
      EvaluateLikelihood({1.0, 1.5, 0.05}, OnePoint(), likelihood, &d);
  const double distance =
      std::log(1.5 + likelihood.epsilon) - std::log(2.0 + likelihood.epsilon);
  EXPECT_DOUBLE_EQ(std::abs(distance) / 2.0, value.misfit);
  EXPECT_DOUBLE_EQ(
      RobustResidual(distance / likelihood.scale, likelihood.delta, nullptr),
      d.residual[1]);
  const Observations exact = MakeObservations({1.0, 2.0, 0.05});
  LikelihoodDerivatives of_value;
  EvaluateLikelihood({1.0, 1.5, 0.05}, exact, likelihood, &of_value);
  EXPECT_EQ(of_value.d_residual[1], d.d_residual[1]);
  EXPECT_EQ(of_value.weight[1], d.weight[1]);
}

TEST(IntervalObservations, DerivativesMatchDifferences) {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> u(-3.0, 3.0);
  const RobustLogLikelihood likelihood{0.05, 1e-6, 0.5};
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<double> at = {std::exp(u(rng)), std::exp(u(rng)),
                                    std::exp(u(rng))};
    LikelihoodDerivatives d;
    EvaluateLikelihood(at, OnePoint(), likelihood, &d);
    for (int c = 0; c < 3; ++c) {
      const double h = 1e-6 * at[c];
      const auto residual = [&](double step) {
        std::vector<double> moved = at;
        moved[c] += step;
        LikelihoodDerivatives of;
        EvaluateLikelihood(moved, OnePoint(), likelihood, &of);
        return of.residual[c];
      };
      EXPECT_NEAR((residual(h) - residual(-h)) / (2 * h), d.d_residual[c],
                  1e-5 * std::abs(d.d_residual[c]) + 1e-6)
          << at[c];
    }
  }
}

// Values of no width are values: the same bits.
TEST(IntervalObservations, OfEqualEndsAreValues) {
  const std::vector<double> values = {1.0, 2.0, 0.1};
  const std::vector<double> L_o = {1.3, 0.2, 0.1};
  LikelihoodDerivatives a, b;
  const LikelihoodValue exact =
      EvaluateLikelihood(L_o, MakeObservations(values), {}, &a);
  const LikelihoodValue equal =
      EvaluateLikelihood(L_o, MakeObservations(values, values, values), {}, &b);
  EXPECT_EQ(exact.cost, equal.cost);
  EXPECT_EQ(exact.misfit, equal.misfit);
  EXPECT_EQ(a.d_residual, b.d_residual);
  EXPECT_EQ(a.weight, b.weight);
}

}  // namespace
}  // namespace ibrdf
