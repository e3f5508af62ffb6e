#include "ibrdf/base/dual.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ibrdf {
namespace {

// Every operation once; works on doubles and duals.
template <typename T>
T Formula(const T& a, const T& b) {
  using std::abs;
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::log;
  using std::sin;
  using std::sqrt;
  T sum = a * b - b / a + T(2.0) * a;
  sum += exp(-a) * log(b + 3.0) / sqrt(a * a + 1.0);
  sum += sin(a * b) * cos(a - b) + atan2(b, a) * atan2(a, T(2.0));
  return sum - abs(b) * abs(a) + 1.0 / b;
}

TEST(Dual, DerivativesAreThoseOfDifferences) {
  // Central differences: truncation and rounding of 1e-10.
  constexpr double kStep = 1e-5, kTolerance = 1e-8;
  for (const double a : {-1.3, 0.4, 2.0}) {
    for (const double b : {-0.7, 0.2, 5.0}) {
      const Dual value = Formula(Dual(a, 2, 0), Dual(b, 2, 1));
      EXPECT_DOUBLE_EQ(Formula(a, b), value.value);
      ASSERT_EQ(2u, value.derivatives.size());
      EXPECT_NEAR((Formula(a + kStep, b) - Formula(a - kStep, b)) / (2 * kStep),
                  value.derivatives[0],
                  kTolerance * (1 + std::abs(value.derivatives[0])));
      EXPECT_NEAR((Formula(a, b + kStep) - Formula(a, b - kStep)) / (2 * kStep),
                  value.derivatives[1],
                  kTolerance * (1 + std::abs(value.derivatives[1])));
    }
  }
}

TEST(Dual, ConstantsHaveNoDerivatives) {
  EXPECT_TRUE(Formula(Dual(1.5), Dual(0.5)).derivatives.empty());
  // On either side of a variable they count as zero.
  const Dual x(3.0, 1, 0);
  EXPECT_EQ(-1.0, (Dual(2.0) - x).derivatives[0]);
  EXPECT_EQ(1.0, (x - Dual(2.0)).derivatives[0]);
  EXPECT_DOUBLE_EQ(-2.0 / 9.0, (Dual(2.0) / x).derivatives[0]);
}

TEST(Dual, OfLongDoubleKeepsItsPrecision) {
  using Long = BasicDual<long double>;
  const Long value = Formula(Long(0.4L, 2, 0), Long(5.0L, 2, 1));
  EXPECT_EQ(Formula(0.4L, 5.0L), value.value);
  // Differences at the best step leave 1e-12: no double carries that far.
  constexpr long double kStep = 1e-6L, kTolerance = 1e-11L;
  const long double by_b =
      (Formula(0.4L, 5.0L + kStep) - Formula(0.4L, 5.0L - kStep)) / (2 * kStep);
  EXPECT_LT(std::abs(by_b - value.derivatives[1]), kTolerance);
}

TEST(Dual, ComparesValues) {
  const Dual a(1.0, 1, 0), b(2.0);
  EXPECT_TRUE(a < b);
  EXPECT_TRUE(b > a);
  EXPECT_TRUE(a >= a);
  EXPECT_FALSE(a >= b);
}

}  // namespace
}  // namespace ibrdf
