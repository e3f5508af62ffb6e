#include "ibrdf/solvers/solve/curve_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSettled = 0.02;

TEST(MinimiseOnLine, FindsAParabolasVertex) {
  int calls = 0;
  const LineMinimum minimum = MinimiseOnLine(
      [&](double x) {
        ++calls;
        return 3.0 + 4.0 * (x - 0.37) * (x - 0.37);
      },
      -2.0, 2.0, 5, 2, kSettled);
  EXPECT_NEAR(0.37, minimum.at, 1e-9);
  EXPECT_NEAR(3.0, minimum.value, 1e-12);
  EXPECT_NEAR(8.0, minimum.curvature, 1e-9);
  EXPECT_EQ(6, calls);
}

TEST(MinimiseOnLine, ComesNearTheMinimumOfOthers) {
  const auto f = [](double x) { return std::cosh(x - 0.8) + 0.1 * x * x * x; };
  const LineMinimum minimum = MinimiseOnLine(f, -2.0, 2.0, 5, 3, kSettled);
  for (double x = -2.0; x <= 2.0; x += 0.01) {
    EXPECT_LE(minimum.value, f(x) + 1e-3);
  }
}

TEST(MinimiseOnLine, StopsWhereItIsSettled) {
  int calls = 0;
  const auto f = [&](double x) {
    ++calls;
    return (x - 0.1) * (x - 0.1);
  };
  EXPECT_EQ(0.0, MinimiseOnLine(f, -2.0, 2.0, 5, 2, 0.11).at);
  EXPECT_EQ(5, calls);
  EXPECT_NEAR(0.1, MinimiseOnLine(f, -2.0, 2.0, 5, 2, 0.09).at, 1e-9);
}

TEST(MinimiseOnLine, EndsAreAllowed) {
  const LineMinimum minimum = MinimiseOnLine(
      [](double x) { return std::exp(x); }, -2.0, 2.0, 5, 2, kSettled);
  EXPECT_EQ(-2.0, minimum.at);
  const LineMinimum line =
      MinimiseOnLine([](double x) { return -x; }, -2.0, 2.0, 5, 2, kSettled);
  EXPECT_EQ(2.0, line.at);
  EXPECT_EQ(0.0, line.curvature);
}

TEST(MinimiseOnLine, PassesOverWhatHasNoValue) {
  const auto f = [](double x) {
    return x < -0.5 ? kInfinity : (x - 0.1) * (x - 0.1);
  };
  EXPECT_NEAR(0.1, MinimiseOnLine(f, -2.0, 2.0, 5, 2, kSettled).at, 1e-9);
  const LineMinimum none = MinimiseOnLine([](double) { return kInfinity; },
                                          -2.0, 2.0, 5, 2, kSettled);
  EXPECT_EQ(kInfinity, none.value);
}

}  // namespace
}  // namespace ibrdf
