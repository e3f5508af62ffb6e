#include "ibrdf/solvers/costs/laplace_interval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/non_finite.h"

namespace ibrdf {
namespace {

// Midpoints of the density.
double Slow(double low, double high, double mean, double b) {
  constexpr int kSteps = 2000000;
  const double from = std::max(low, mean - 60.0 * b);
  const double to = std::min(high, mean + 60.0 * b);
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double x = from + (to - from) * (k + 0.5) / kSteps;
    sum += std::exp(-std::abs(x - mean) / b) / (2.0 * b);
  }
  return -std::log(sum * (to - from) / kSteps);
}

TEST(LaplaceIntervalCost, IsTheIntegral) {
  for (const double b : {0.02, 0.5}) {
    for (const double mean : {-0.3, 0.0, 0.05, 0.8}) {
      for (const auto& [low, high] :
           {std::pair(-0.1, 0.2), {0.0, 0.01}, {0.3, 0.9}, {-2.0, -0.5}}) {
        const double expected = Slow(low, high, mean, b);
        if (!(expected < 40.0)) continue;
        EXPECT_NEAR(expected, LaplaceIntervalCost(low, high, mean, b),
                    1e-6 * std::max(expected, 1.0))
            << b << " " << mean << " " << low;
      }
      EXPECT_NEAR(Slow(0.1, kInfinity, mean, b),
                  LaplaceIntervalCost(0.1, kInfinity, mean, b), 1e-5);
      EXPECT_NEAR(Slow(-kInfinity, 0.1, mean, b),
                  LaplaceIntervalCost(-kInfinity, 0.1, mean, b), 1e-5);
    }
  }
}

TEST(LaplaceIntervalCost, IsFiniteAndNeverNegative) {
  for (const double width : {0.0, 1e-12, 1.0, kInfinity}) {
    for (const double low : {-1e5, -1.0, 0.0, 1.0, 1e5}) {
      const double cost = LaplaceIntervalCost(low, low + width, 0.0, 0.003);
      EXPECT_TRUE(std::isfinite(cost)) << width << " " << low;
      EXPECT_GE(cost, 0.0);
    }
  }
  EXPECT_EQ(0.0, LaplaceIntervalCost(-kInfinity, kInfinity, 3.0, 0.1));
}

}  // namespace
}  // namespace ibrdf
