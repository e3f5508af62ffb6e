#include "ibrdf/solvers/solve/curve_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace ibrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSettled = 0.02;

// From five points of [-2, 2].
LineMinimum Minimise(const std::function<double(double)>& f, int refinements,
                     double settled = kSettled) {
  return MinimiseOnLine(
      f, {-2.0, 2.0, EqualSteps(-2.0, 2.0, 5), refinements, settled});
}

TEST(MinimiseOnLine, FindsAParabolasVertex) {
  int calls = 0;
  const LineMinimum minimum = Minimise(
      [&](double x) {
        ++calls;
        return 3.0 + 4.0 * (x - 0.37) * (x - 0.37);
      },
      2);
  EXPECT_NEAR(0.37, minimum.at, 1e-9);
  EXPECT_NEAR(3.0, minimum.value, 1e-12);
  EXPECT_NEAR(8.0, minimum.curvature, 1e-9);
  EXPECT_EQ(6, calls);
}

TEST(MinimiseOnLine, ComesNearTheMinimumOfOthers) {
  const auto f = [](double x) { return std::cosh(x - 0.8) + 0.1 * x * x * x; };
  const LineMinimum minimum = Minimise(f, 3);
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
  EXPECT_EQ(0.0, Minimise(f, 2, 0.11).at);
  EXPECT_EQ(5, calls);
  EXPECT_NEAR(0.1, Minimise(f, 2, 0.09).at, 1e-9);
}

TEST(MinimiseOnLine, EndsAreAllowed) {
  const LineMinimum minimum = Minimise([](double x) { return std::exp(x); }, 2);
  EXPECT_EQ(-2.0, minimum.at);
  const LineMinimum line = Minimise([](double x) { return -x; }, 2);
  EXPECT_EQ(2.0, line.at);
  EXPECT_EQ(0.0, line.curvature);
  // No Laplace approximation holds at an end, whatever the parabola there.
  const LineMinimum beyond =
      Minimise([](double x) { return (x - 3.0) * (x - 3.0); }, 2);
  EXPECT_EQ(2.0, beyond.at);
  EXPECT_EQ(0.0, beyond.curvature);
}

TEST(MinimiseOnLine, LeavesItsStartsWhereTheFunctionFalls) {
  const std::vector<double> starts = {0.0, -1.0, 1.0};
  const auto bowl = [](double x) { return (x - 1.6) * (x - 1.6); };
  EXPECT_NEAR(1.6, MinimiseOnLine(bowl, {-2.0, 2.0, starts, 3, kSettled}).at,
              1e-9);
  // No parabola through the starts has a lowest point.
  const auto hill = [](double x) { return -(x + 0.5) * (x + 0.5); };
  EXPECT_EQ(2.0, MinimiseOnLine(hill, {-2.0, 2.0, starts, 3, kSettled}).at);
  const auto other = [](double x) { return -(x - 0.5) * (x - 0.5); };
  EXPECT_EQ(-2.0, MinimiseOnLine(other, {-2.0, 2.0, starts, 3, kSettled}).at);
}

TEST(MinimiseOnLine, PassesOverWhatHasNoValue) {
  const auto f = [](double x) {
    return x < -0.5 ? kInfinity : (x - 0.1) * (x - 0.1);
  };
  EXPECT_NEAR(0.1, Minimise(f, 2).at, 1e-9);
  const LineMinimum none = Minimise([](double) { return kInfinity; }, 2);
  EXPECT_EQ(kInfinity, none.value);
}

}  // namespace
}  // namespace ibrdf
