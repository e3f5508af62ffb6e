#include "ibrdf/brdf/bivariate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/metrics/brdf_metrics.h"

namespace ibrdf {
namespace {

double LogRmse(const BivariateTable& estimate, const MerlTable& reference) {
  return CompareBrdfs(SampleMerl(estimate.Function()), reference)
      .value()
      .log_rmse;
}

// Depends on all three angles, over four orders of magnitude.
MerlTable Table() {
  return SampleMerl([](double h, double d, double p) -> Eigen::Array3d {
    const double c = std::cos(p);
    return Eigen::Array3d(1.0, 0.3, 0.01) *
           (std::exp(-20 * h * h + d + c * c) + 1e-3);
  });
}

TEST(Bivariate, IsExactWhereTheTableDoesNotDependOnPhi) {
  const MerlTable table =
      SampleMerl([](double h, double d, double) -> Eigen::Array3d {
        return {std::exp(-30 * h * h), 0.2 + d, 1e-4};
      });
  for (const BivariateMean mean :
       {BivariateMean::kGeometric, BivariateMean::kArithmetic}) {
    const BivariateTable fit = FitBivariate(table, mean).value();
    // Rounding of logarithms, of sums and of the interpolation's position.
    EXPECT_LT(LogRmse(fit, table), 1e-9);
    EXPECT_NEAR(table.Raw(1, MerlTable::Bin(3, 40, 90)), fit.Raw(1, 3, 40),
                1e-9 * fit.Raw(1, 3, 40));
  }
}

TEST(Bivariate, GeometricMeanHasTheLeastLogRmse) {
  const MerlTable table = Table();
  const BivariateTable best =
      FitBivariate(table, BivariateMean::kGeometric).value();
  const double least = LogRmse(best, table);
  EXPECT_LT(
      least,
      LogRmse(FitBivariate(table, BivariateMean::kArithmetic).value(), table));
  std::mt19937 rng(11);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2; ++i) {
    BivariateTable other = best;
    for (double& raw : other.raw) raw *= std::exp(1e-2 * normal(rng));
    // In log space orthogonal to the residual: squares add.
    EXPECT_NEAR(std::hypot(least, 1e-2), LogRmse(other, table), 1e-4);
    for (double& raw : other.raw) raw *= i == 0 ? 1.001 : 0.999;
    EXPECT_GT(LogRmse(other, table), least);
  }
}

TEST(Bivariate, MeansOfOneCell) {
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  const int a = MerlTable::Bin(10, 20, 0), b = MerlTable::Bin(10, 20, 7);
  for (int c = 0; c < 3; ++c) {
    table.raw[static_cast<size_t>(c) * kMerlBins + a] = 1.0;
    table.raw[static_cast<size_t>(c) * kMerlBins + b] = 9.0;
  }
  // Not a valid bin: its red value is 0.
  table.raw[static_cast<size_t>(kMerlBins) + MerlTable::Bin(10, 20, 8)] = 1e9;
  table.raw[MerlTable::Bin(10, 20, 8)] = 0.0;
  const BivariateTable geometric =
      FitBivariate(table, BivariateMean::kGeometric).value();
  const BivariateTable arithmetic =
      FitBivariate(table, BivariateMean::kArithmetic).value();
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(3.0, geometric.Raw(c, 10, 20), 1e-5);  // the floor of 1e-6
    EXPECT_DOUBLE_EQ(5.0, arithmetic.Raw(c, 10, 20));
    // Cells without bins take the value of the column, or 0.
    EXPECT_EQ(arithmetic.Raw(c, 10, 20), arithmetic.Raw(c, 0, 20));
    EXPECT_EQ(arithmetic.Raw(c, 10, 20), arithmetic.Raw(c, 89, 20));
    EXPECT_EQ(0.0, arithmetic.Raw(c, 10, 21));
  }
}

TEST(Bivariate, RefusesTablesWithoutValuesAndNonFiniteOnes) {
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  EXPECT_EQ("table: red: expected a bin with a positive value",
            FitBivariate(table, BivariateMean::kGeometric).status().message());
  table = Table();
  table.raw[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(StatusCode::kInvalidInput,
            FitBivariate(table, BivariateMean::kArithmetic).status().code());
}

TEST(Bivariate, IsFiniteForZeroAndNegativeValues) {
  MerlTable table = Table();
  for (int bin = 0; bin < kMerlBins; ++bin) {
    if (bin % 3 == 0) table.raw[static_cast<size_t>(kMerlBins) + bin] = -5.0;
    if (bin % 3 == 1) table.raw[2 * static_cast<size_t>(kMerlBins) + bin] = 0.0;
  }
  for (const BivariateMean mean :
       {BivariateMean::kGeometric, BivariateMean::kArithmetic}) {
    const BivariateTable fit = FitBivariate(table, mean).value();
    for (const double raw : fit.raw) {
      ASSERT_TRUE(std::isfinite(raw));
      ASSERT_GE(raw, 0.0);
    }
  }
}

}  // namespace
}  // namespace ibrdf
