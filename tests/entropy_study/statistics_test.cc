#include "ibrdf/solvers/entropy_study/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace ibrdf {
namespace {

using Numbers = std::vector<double>;

TEST(Statistics, CorrelationsOfAFewNumbers) {
  const Numbers x = {1, 2, 3, 4}, y = {2, 4, 6, 8}, z = {1, 8, 27, 64};
  EXPECT_NEAR(1.0, Pearson(x, y), 1e-12);
  EXPECT_NEAR(-1.0, Pearson(x, {4, 3, 2, 1}), 1e-12);
  EXPECT_EQ(0.0, Pearson(x, {5, 5, 5, 5}));
  EXPECT_NEAR(1.0, Spearman(x, z), 1e-12);
  EXPECT_LT(Pearson(x, z), 0.96);
  // Equal values share a rank: 0, 1.5, 1.5, 3 against 0, 1, 2, 3.
  EXPECT_NEAR(4.5 / std::sqrt(4.5 * 5.0), Spearman({1, 2, 2, 3}, x), 1e-12);
}

// x and y are z and noise of their own: without z nothing is left.
TEST(Statistics, PartialCorrelationIsThatOfResiduals) {
  std::mt19937 rng(5);
  std::normal_distribution<double> gauss;
  Numbers x, y, z;
  for (int i = 0; i < 4000; ++i) {
    z.push_back(gauss(rng));
    x.push_back(z.back() + 0.5 * gauss(rng));
    y.push_back(z.back() + 0.5 * gauss(rng));
  }
  EXPECT_GT(Pearson(x, y), 0.7);
  EXPECT_NEAR(0.0, PartialCorrelation(x, y, z), 0.05);
  // The residuals, as they stand.
  const auto residual = [&](const Numbers& v) {
    double vz = 0.0, zz = 0.0;
    for (size_t i = 0; i < v.size(); ++i) {
      vz += (v[i] - Mean(v)) * (z[i] - Mean(z));
      zz += (z[i] - Mean(z)) * (z[i] - Mean(z));
    }
    Numbers out;
    for (size_t i = 0; i < v.size(); ++i) out.push_back(v[i] - vz / zz * z[i]);
    return out;
  };
  EXPECT_NEAR(Pearson(residual(x), residual(y)), PartialCorrelation(x, y, z),
              1e-9);
}

TEST(Statistics, AreaIsTheShareOfPairsInOrder) {
  const Numbers y = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(1.0, AreaForTopFifth(y, y));
  EXPECT_EQ(0.0, AreaForTopFifth({9, 8, 7, 6, 5, 4, 3, 2, 1, 0}, y));
  EXPECT_EQ(0.5, AreaForTopFifth(Numbers(10, 1.0), y));
  // Among 8 others, 8 has five below it and 9 all.
  EXPECT_NEAR(13.0 / 16.0, AreaForTopFifth({0, 1, 2, 3, 4, 6, 7, 8, 5, 9}, y),
              1e-12);
}

TEST(Statistics, PairedTTestHasTheTablesValues) {
  // Differences 1, 2, 3: mean 2, standard error 1 / sqrt(3), two degrees.
  const TTest three = PairedTTest({2, 4, 6}, {1, 2, 3});
  EXPECT_NEAR(2.0 * std::sqrt(3.0), three.t, 1e-12);
  EXPECT_NEAR(0.0741799, three.p, 1e-5);
  // Student's 5 % point of 9 degrees is 2.262157.
  Numbers x;
  for (int i = 0; i < 10; ++i) x.push_back(i % 2 == 0 ? 1.0 : -1.0);
  const double error = std::sqrt(10.0 / 9.0 / 10.0);
  for (double& v : x) v += 2.262157 * error;
  EXPECT_NEAR(0.05, PairedTTest(x, Numbers(10, 0.0)).p, 1e-5);
}

}  // namespace
}  // namespace ibrdf
