#include "ibrdf/solvers/costs/interval_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "tests/support/non_finite.h"

namespace ibrdf {
namespace {

// log of the probability by the error function in long double; good where the
// difference is, in one tail at most 40 deviations out.
long double LogProbability(long double low, long double high, long double mean,
                           long double s) {
  long double a = (low - mean) / s, b = (high - mean) / s;
  if (a > 0) {
    const long double other = a;
    a = -b;
    b = -other;
  }
  const long double root = std::sqrt(2.0L);
  return std::log(0.5L * (std::erfc(-b / root) - std::erfc(-a / root)));
}

struct Interval {
  double low, high;
};

std::vector<Interval> Intervals() {
  return {{-0.5, 0.7},       {0.2, kInfinity},  {-kInfinity, -0.4},
          {-1e-3, 1e-3},     {1.0, 1.3},        {-3.0, -2.9},
          {-2.0, kInfinity}, {-kInfinity, 2.0}, {-30.0, 40.0},
          {0.0, 0.5},        {0.0, kInfinity},  {-1.2, 0.0}};
}

TEST(IntervalLikelihood, IsTheProbability) {
  for (const Interval& of : Intervals()) {
    for (const double s : {0.03, 0.3, 2.0}) {
      for (const double mean : {-1.0, -0.2, 0.0, 0.6}) {
        const long double expected = -LogProbability(of.low, of.high, mean, s);
        if (!std::isfinite(static_cast<double>(expected))) continue;
        EXPECT_NEAR(EvaluateInterval(of.low, of.high, mean, s).cost,
                    static_cast<double>(expected),
                    1e-11 * std::max(1.0L, expected))
            << of.low << " " << of.high << " " << s << " " << mean;
      }
    }
  }
}

// To second order in the step, from one derivative to the next.
TEST(IntervalLikelihood, DerivativesMatchDifferences) {
  for (const Interval& of : Intervals()) {
    for (const double s : {0.03, 0.3, 2.0}) {
      for (double mean = -3.0; mean < 3.0; mean += 0.37) {
        const double h = 1e-4 * s;
        const IntervalLikelihood at =
            EvaluateInterval(of.low, of.high, mean, s);
        const IntervalLikelihood up =
            EvaluateInterval(of.low, of.high, mean + h, s);
        const IntervalLikelihood down =
            EvaluateInterval(of.low, of.high, mean - h, s);
        const double unit = 1.0 / s;
        EXPECT_NEAR(
            (down.cost - up.cost) / (2 * h), at.slope,
            1e-7 * (std::abs(at.slope) + unit) + 1e-11 * std::abs(at.cost) / h);
        EXPECT_NEAR((down.slope - up.slope) / (2 * h), at.curvature,
                    1e-7 * unit * unit + 1e-11 * std::abs(at.slope) / h);
        EXPECT_NEAR((up.curvature - down.curvature) / (2 * h), at.third,
                    1e-7 * unit * unit * unit + 1e-11 * unit * unit / h);
        EXPECT_GE(at.curvature, 0.0);
        EXPECT_LE(at.curvature, unit * unit);
      }
    }
  }
}

TEST(IntervalLikelihood, OfNoWidthIsTheDensity) {
  constexpr double kWidth = 1e-6;
  for (const double mean : {-0.3, 0.0, 0.1, 2.0}) {
    const double s = 0.1;
    const IntervalLikelihood of =
        EvaluateInterval(-0.5 * kWidth, 0.5 * kWidth, mean, s);
    const double cost = 0.5 * mean * mean / (s * s) +
                        std::log(s * std::sqrt(2.0 * kPi) / kWidth);
    EXPECT_NEAR(cost, of.cost, 1e-9 * std::abs(cost) + 1e-9);
    EXPECT_NEAR(-mean / (s * s), of.slope, 1e-6);
    EXPECT_NEAR(1.0 / (s * s), of.curvature, 1e-6 / (s * s));
    EXPECT_NEAR(0.0, of.third, 1e-4 / (s * s * s));
  }
}

TEST(IntervalLikelihood, WithoutEndsSaysNothing) {
  const IntervalLikelihood of =
      EvaluateInterval(-kInfinity, kInfinity, 3.0, 0.1);
  EXPECT_EQ(0.0, of.cost);
  EXPECT_EQ(0.0, of.slope);
  EXPECT_EQ(0.0, of.curvature);
  EXPECT_EQ(0.0, of.third);
}

// One end far away is a parabola from there: nothing overflows, and a step
// towards it has a slope.
TEST(IntervalLikelihood, IsFiniteFarOutside) {
  for (const double far : {30.0, 700.0, 1e5}) {
    for (const double s : {0.03, 1.0}) {
      for (const double width : {0.0, 1e-12, 0.5, kInfinity}) {
        const IntervalLikelihood above =
            EvaluateInterval(far, far + width, 0.0, s);
        const IntervalLikelihood below =
            EvaluateInterval(-far - width, -far, 0.0, s);
        EXPECT_TRUE(std::isfinite(above.cost));
        EXPECT_NEAR(1.0, above.slope * s * s / far, 0.01);
        EXPECT_NEAR(1.0, above.curvature * s * s, 0.01);
        EXPECT_TRUE(std::isfinite(above.third));
        // Mirrored, but for the end that the least width moves.
        EXPECT_NEAR(above.cost / below.cost, 1.0, 1e-9);
        EXPECT_NEAR(-above.slope / below.slope, 1.0, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
