#include "ibrdf/base/gauss_legendre.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ibrdf {
namespace {

constexpr double kRounding = 1e-12;

TEST(GaussLegendre, IsExactForPolynomials) {
  for (const int n : {1, 2, 7, 40, 128}) {
    std::vector<double> x, w;
    GaussLegendre(n, &x, &w);
    for (const int power : {0, 1, n, 2 * n - 1}) {
      double sum = 0.0;
      for (int i = 0; i < n; ++i) sum += w[i] * std::pow(x[i], power);
      EXPECT_NEAR(sum, 1.0 / (power + 1), kRounding) << n << " " << power;
    }
  }
}

}  // namespace
}  // namespace ibrdf
